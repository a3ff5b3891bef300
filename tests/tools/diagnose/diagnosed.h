/// Common checks of a diagnosis.
#pragma once
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>
#include "tools/diagnose/diagnose.h"

namespace loopwright {

inline std::vector<std::string> names(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const DiagnosedEffect& effect : d.effects) list.push_back(effect.name);
  return list;
}

/// The truth lies within four standard deviations, computed from the 95 % interval (which a correct answer
/// misses once in twenty times), and the interval is no wider than `width`.
inline void expect_parameter(const DiagnosedEffect& effect, const std::string& name, double truth,
                             double width, const std::string& unit) {
  const auto p = std::ranges::find(effect.parameters, name, &DiagnosedParameter::name);
  ASSERT_NE(p, effect.parameters.end()) << name;
  EXPECT_LT(std::abs(p->value - truth), 4 / 1.96 * (p->high - p->value)) << name;
  EXPECT_LT(p->high - p->low, width) << name;
  EXPECT_EQ(p->unit, unit) << name;
  EXPECT_FALSE(p->at_limit) << name;
}

}  // namespace loopwright
