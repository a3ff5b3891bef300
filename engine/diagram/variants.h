/// Blocks with variants: {"variants": {"simulated": {…}, "quanser": {…}}, "variant": "simulated", "in": {…}}.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// `--variant stage=quanser`, seen from one diagram of the nesting.
struct VariantChoice {
  std::vector<std::string> path;
  size_t depth = 0;  ///< names that lead to the present diagram, or to the block if it is all of them
  std::string variant;
  Place place;

  bool is_here() const { return depth == path.size(); }
};

/// Nothing after a problem.
std::optional<VariantChoice> read_variant_choice(const std::string& path, const std::string& variant,
                                                 Problems& problems);

/// The body of the active variant, whose name is stored in `entry`; null after a problem. The active variant
/// is the one chosen by the caller, otherwise by "variant", otherwise the first. Choices for this block are
/// removed from `choices`; the others lead deeper.
const Value* active_variant(const Value& block, BlockEntry& entry, std::vector<VariantChoice>& choices,
                            const Reader& reader);

}  // namespace loopwright
