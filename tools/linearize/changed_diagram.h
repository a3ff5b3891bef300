/// Diagrams with blocks added between a wire and the port that reads it, for runs like experiments.
#pragma once
#include <optional>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A block with numbers as its settings, in SI. Without wires.
BlockEntry block_with(std::string name, std::string type,
                      std::initializer_list<std::pair<const char*, double>> settings);

/// The wires into an input port of an outermost block, named "sum.terms" or "sum.in.terms"; null: none.
const PortWires* wires_into(const Diagram& diagram, const std::string& port);

/// The diagram with the output `block.y` of a source added to what an input port of an outermost block reads,
/// from `time` [s] on; none: from the start. Problems for a port that does not exist or is inside a
/// subdiagram.
Diagram with_added_signal(const Diagram& diagram, const std::string& port, const BlockEntry& source,
                          Problems& problems, std::optional<double> time = {});

/// The diagram with such a port cut: from `time` [s] on (none: from the start) it reads `value` [SI].
Diagram with_cut_port(const Diagram& diagram, const std::string& port, double value,
                      std::optional<double> time, Problems& problems);

}  // namespace loopwright
