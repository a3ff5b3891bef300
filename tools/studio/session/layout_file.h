/// Positions of blocks that a person moved: NAME.layout.json beside NAME.json, a block a line, sorted.
#pragma once
#include <map>
#include <optional>
#include <string>
#include "tools/studio/session/draft.h"

namespace loopwright::studio {

/// By path of the block, in pixels of the canvas.
using Layout = std::map<std::string, std::pair<double, double>>;

std::string layout_path(const std::string& diagram);
/// Empty for a text that is no layout: it is nothing to lose.
Layout read_layout(const std::optional<std::string>& text);
/// Nothing for an empty layout: there is no file.
std::optional<std::string> layout_text(const Layout& layout);

}  // namespace loopwright::studio
