/// Names by which a column is recognized as the time.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>

namespace loopwright {

/// The name without its structure: "log.time" → "time".
inline std::string_view last_part(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == name.npos ? name : name.substr(dot + 1);
}

/// "tout" is the time that Simulink leaves in the workspace.
inline bool is_called_time(std::string_view name) {
  constexpr std::array<std::string_view, 5> names = {"time", "Time", "TIME", "t", "tout"};
  return std::ranges::find(names, name) != names.end();
}

}  // namespace loopwright
