/// Formats quantities and lists for text and page of a diagnosis.
#pragma once
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>
#include "tools/diagnose/diagnosis.h"
#include "tools/report/typography.h"

namespace loopwright {

/// "3.2 mN"
inline std::string shown(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  const report::Quantity q = report::engineering(value, unit);
  return q.unit.empty() ? q.value : fmt::format("{} {}", q.value, q.unit);
}

/// The effect's name in the catalogue, as words.
inline std::string words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "cogging and spring", with " and "
inline std::string joined(const std::vector<std::string>& names, const char* with) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : with) + name;
  return text;
}

inline std::string words_of(const MovedPort& moved) {
  return fmt::format(
      "With the improved diagram, the experiment must name {} in the place of {}: otherwise it does not "
      "reach the added effect.",
      joined(moved.to, " and "), moved.from);
}

/// How the improved diagram was written, if it was.
std::string words_of_improvement(const Diagnosis& diagnosis);

}  // namespace loopwright
