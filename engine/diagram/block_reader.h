/// One entry of "blocks": a block or a subdiagram.
#pragma once
#include <string>
#include <vector>
#include "engine/diagram/diagram_load.h"
#include "engine/json/reader.h"

namespace loopwright {

/// The diagram that contains a block.
struct Surroundings {
  DiagramLoad& load;
  ParameterScope& scope;
  const std::string& path;  ///< of the diagram's file
};

/// Fills everything except the name. `edits` and `variants` are the options whose path leads to this block or
/// into it.
void read_block(const Value::Member& member, std::vector<Edit> edits, std::vector<VariantChoice> variants,
                const Surroundings& around, const Reader& reader, BlockEntry& entry);

}  // namespace loopwright
