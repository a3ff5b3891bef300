/// Wires in a diagram file: the sources of the inputs of a block.
#pragma once
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// "reference.position", "gain.y[2]", "stage.mass.velocity", "command"
bool is_port(std::string_view text);

/// The object "in" of a block.
std::vector<PortWires> read_inputs(const Value& in, const Reader& reader);

/// One source; empty after a problem.
Wire read_wire(const Value& value, std::string_view what, const Reader& reader);

/// The list "log": ports, and patterns such as "stage.*".
std::vector<Wire> read_log(const Value& log, const Reader& reader);

}  // namespace loopwright
