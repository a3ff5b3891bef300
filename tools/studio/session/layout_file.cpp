#include "tools/studio/session/layout_file.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/studio/session/member_change.h"

namespace loopwright::studio {

std::string layout_path(const std::string& diagram) {
  return diagram.substr(0, diagram.rfind(".json")) + ".layout.json";
}

Layout read_layout(const std::optional<std::string>& text) {
  Layout layout;
  if (!text) return layout;
  const ParsedText parsed("layout", *text);
  const Value::Member* blocks = parsed.is_object() ? parsed.root.find("positions") : nullptr;
  if (!blocks) return layout;
  for (const Value::Member& block : blocks->value.members)
    if (block.value.items.size() == 2)
      layout[block.name] = {block.value.items[0].number, block.value.items[1].number};
  return layout;
}

std::optional<std::string> layout_text(const Layout& layout) {
  if (layout.empty()) return {};
  constexpr double farthest = 1e6;  // pixels; a canvas is smaller
  std::string lines;
  for (const auto& [block, position] : layout)
    lines += fmt::format("{}\n    {}: [{:.0f}, {:.0f}]", lines.empty() ? "" : ",", in_quotes(block),
                         std::clamp(position.first, -farthest, farthest),
                         std::clamp(position.second, -farthest, farthest));
  return fmt::format("{{\n  \"positions\": {{{}\n  }}\n}}\n", lines);
}

}  // namespace loopwright::studio
