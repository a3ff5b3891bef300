/// Units of the wires: $names are solved from their neighbors; contradictions name both ends.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// The unit of every output port, by flat block and output; nothing if it could not be determined.
struct PortUnits {
  std::vector<std::optional<Unit>> outputs;
  std::vector<size_t> first;  ///< index of the first output of each block
  const std::optional<Unit>& of(int block, int output) const {
    return outputs[first[size_t(block)] + size_t(output)];
  }
};

PortUnits check_units(const FlatDiagram& flat, const Diagram& diagram, Problems& problems);

/// The outputs that are read or logged and whose unit is not determined.
WiresWithoutUnit wires_without_unit(const FlatDiagram& flat, const PortUnits& units);

}  // namespace loopwright
