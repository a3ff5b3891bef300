/// The inputs and outputs of a diagram that is used as a block.
#pragma once
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// The key "inputs" of a diagram: `"force": "N"` or `"force": {"unit": "N", "description": "…"}`.
std::vector<DiagramInput> read_inputs_of_diagram(const Value& root, const Reader& reader);

/// The key "outputs": `"position": "mass.position"` or
/// `"position": {"source": "mass.position", "unit": "m", "description": "…"}`. An output without a source is
/// omitted.
std::vector<DiagramOutput> read_outputs_of_diagram(const Value& root, const Reader& reader);

}  // namespace loopwright
