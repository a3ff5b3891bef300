/// Units along the wires: $names are solved from their neighbours, clashes name both ends.
#pragma once
#include "engine/plan/flatten.h"

namespace loopwright {

/// The unit of every output port, by flat block and output; nothing where it could not be worked out.
using PortUnits = std::vector<std::vector<std::optional<Unit>>>;

PortUnits check_units(const FlatDiagram& flat, const Diagram& diagram, Problems& problems);

}  // namespace loopwright
