/// One entry of "blocks": a block, or a subdiagram in its place.
#pragma once
#include <string>
#include <vector>
#include "engine/diagram/diagram_load.h"
#include "engine/json/reader.h"

namespace loopwright {

/// The diagram in which a block stands.
struct Surroundings {
  DiagramLoad& load;
  ParameterScope& scope;
  const std::string& path;  ///< of the diagram's file
};

/// Fills everything but the name. `edits` and `variants` are the options that lead to this block or inside
/// it.
void read_block(const Value::Member& member, std::vector<Edit> edits, std::vector<VariantChoice> variants,
                const Surroundings& around, const Reader& reader, BlockEntry& entry);

}  // namespace loopwright
