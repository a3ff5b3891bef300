#include <gtest/gtest.h>
#include <cmath>
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::effect_run_again_test {

TEST(EffectRun, BeginsAnewEachTime) {
  std::vector<double> position, velocity, acceleration, input;
  for (int k = 0; k < 3000; ++k) {
    const double w = 2 * M_PI * 1.3, t = 1e-3 * k;
    position.push_back(0.3 - 0.1 * std::cos(w * t)), velocity.push_back(0.1 * w * std::sin(w * t));
    acceleration.push_back(0.1 * w * w * std::cos(w * t)), input.push_back(std::sin(1.7 * w * t));
  }
  const RoleSignals signals{position, velocity, acceleration, input, input, false, {}};
  for (const Effect& effect : whole_catalogue())
    for (const int lanes : {1, 8}) {
      Problems problems;
      EffectRun effect_run(compile_effect(effect, {}, axis_sizes(), problems), lanes);
      std::vector<EffectRun::Output> first(1), again(1);
      effect_run.run(signals, position.size(), first);
      effect_run.run(signals, position.size(), again);
      EXPECT_TRUE(again[0].mean == first[0].mean && again[0].slope == first[0].slope)
          << effect.name << " " << effect.form << " " << lanes;
    }
}

}  // namespace loopwright::effect_run_again_test
