/// Blocks that can be one of several: {"variants": {"simulated": {…}, "quanser": {…}}, "variant":
/// "simulated", "in": {…}}.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// `--variant stage=quanser`, seen from one diagram in the nest.
struct VariantChoice {
  std::vector<std::string> path;
  size_t depth = 0;  ///< names that lead to the diagram in hand, or to the block when it is all of them
  std::string variant;
  Place place;

  bool is_here() const { return depth == path.size(); }
};

/// Nothing after a problem.
std::optional<VariantChoice> read_variant_choice(const std::string& path, const std::string& variant,
                                                 Problems& problems);

/// The body of the active variant, whose name goes into `entry`; null after a problem. Active is what the
/// caller chose, else what "variant" says, else the first. Choices for this block are taken out of `choices`,
/// the others lead deeper.
const Value* active_variant(const Value& block, BlockEntry& entry, std::vector<VariantChoice>& choices,
                            const Reader& reader);

}  // namespace loopwright
