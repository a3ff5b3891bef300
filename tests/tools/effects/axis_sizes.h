/// The sizes of a synthetic axis, and the catalogue.
#pragma once
#include <gtest/gtest.h>
#include <stdexcept>
#include "tools/effects/effect.h"

namespace loopwright {

inline RecordSizes axis_sizes() {
  RecordSizes s;
  s.stroke = 0.6, s.lowest_position = 0, s.highest_position = 0.6, s.top_speed = 0.4, s.top_acceleration = 5;
  s.force_level = s.input_level = 0.6, s.machine_mass = 0.2621, s.machine_damping = 3, s.resolution = 2e-7, s.duration = 12;
  return s;
}

inline std::vector<Effect> whole_catalogue() {
  Problems problems;
  auto effects = load_catalogue({catalogue_folder()}, problems);
  EXPECT_EQ(problems.text(), "");
  return effects;
}

/// The first form of an effect.
inline Effect effect_named(const std::string& name) {
  for (Effect& effect : whole_catalogue())
    if (effect.name == name) return effect;
  throw std::invalid_argument("no effect " + name);
}

}  // namespace loopwright
