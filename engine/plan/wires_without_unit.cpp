#include "engine/plan/wires_without_unit.h"
#include <algorithm>
#include <fmt/format.h>

namespace loopwright {

std::string to_string(const WiresWithoutUnit& wires) {
  if (wires.count == 0) return "";
  constexpr size_t most_shown = 5;
  const size_t shown = std::min(most_shown, wires.named.size());
  std::string text = fmt::format("{} wire{} without a unit: ", wires.count, wires.count == 1 ? "" : "s");
  for (size_t i = 0; i < shown; ++i) text += (i ? ", " : "") + wires.named[i].output;
  return text + (shown < wires.count ? " …" : "");
}

void refuse(const WiresWithoutUnit& wires, Problems& problems) {
  for (const auto& [output, place] : wires.named) {
    const std::string block = output.substr(0, output.rfind('.'));
    auto& p =
        problems.error(place, place.pointer(), block, fmt::format("nothing decides the unit of {}", output));
    p.expected = "a number with a unit somewhere along its wires, as in {\"value\": 1, \"unit\": \"m\"}";
  }
  if (wires.count <= wires.named.size() || wires.named.empty()) return;
  const Place& place = wires.named.back().place;
  problems.error(place, "", "", fmt::format("{} more wires have no unit", wires.count - wires.named.size()));
}

}  // namespace loopwright
