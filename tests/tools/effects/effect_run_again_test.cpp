#include <gtest/gtest.h>
#include <cmath>
#include "tests/engine/written_diagram.h"
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

/// The parameters that a formula reads are those of its own set.
TEST(EffectRun, GivesEachSetOfAFormulaItsOwnParameters) {
  DiagramFolder folder;
  folder.with("bend.json",
              R"json({"loopwright": 1, "effect": "bend", "title": "A bend", "physics": "A formula.",
    "parameters": {"loss": {"description": "Share", "unit": "1", "linear": true, "range": [0, 2], "start": 1},
                   "limit": {"description": "Limit", "unit": "$input", "scale": "logarithmic", "range": [0.3, 10], "start": 2}},
    "blocks": {"motor": {"type": "Expression", "formula": "u - loss*(u - limit*tanh(u/limit))*two*stroke/(2*stroke)", "names": ["u"],
                         "constants": [{"name": "two", "value": 2}],
                         "in": {"arguments": ["input"]}}},
    "attach": [{"to": "input", "from": "motor.y"}], "needs": {"text": "motion"}})json");
  Problems problems;
  const std::vector<Effect> effects = load_effect(folder.path("bend.json"), problems);
  ASSERT_EQ(problems.text(), "");
  std::vector<double> none(100), input;
  for (size_t k = 0; k < none.size(); ++k) input.push_back(0.05 * double(k));
  const RoleSignals signals{none, none, none, input, none, false, {}};
  for (const int lanes : {1, 8}) {
    EffectRun run(compile_effect(effects.front(), {}, axis_sizes(), problems), lanes);
    std::vector<EffectRun::Output> outputs(static_cast<size_t>(run.lanes()));
    const auto limit_of = [](int lane) { return 0.5 + 0.7 * lane; };
    for (int lane = 0; lane < run.lanes(); ++lane) run.set(0, 1, lane), run.set(1, limit_of(lane), lane);
    run.run(signals, input.size(), outputs);
    for (int lane = 0; lane < run.lanes(); ++lane)
      for (size_t k = 0; k < input.size(); ++k)
        ASSERT_NEAR(outputs[size_t(lane)].mean[k],
                    limit_of(lane) * std::tanh(input[k] / limit_of(lane)) - input[k], 1e-6)
            << "set " << lane << " of " << lanes << ", sample " << k;
  }
}

/// A table that ends within the motion: rows side by side on lanes would be those of the last row within it.
TEST(EffectRun, RefusesABlockThatFaults) {
  DiagramFolder folder;
  folder.with("place.json",
              R"json({"loopwright": 1, "effect": "place", "title": "Force of a place", "physics": "A table.",
    "parameters": {"level": {"description": "Size", "unit": "$force", "linear": true, "range": [0, 1], "start": 0.1}},
    "blocks": {"table": {"type": "Lookup1D", "breakpoints": [{"value": 0.25, "unit": "m"}, {"value": 0.35, "unit": "m"}],
                         "values": [1, 2], "outside": "fault", "in": {"u": "position"}},
               "force": {"type": "Gain", "gain": "=level", "in": {"u": "table.y"}}},
    "attach": [{"to": "force", "from": "force.y"}], "needs": {"text": "motion"}})json");
  Problems problems;
  const std::vector<Effect> effects = load_effect(folder.path("place.json"), problems);
  ASSERT_EQ(problems.text(), "");
  for (const double way : {0.04, 0.1}) {
    std::vector<double> position, none(3000);
    for (size_t k = 0; k < none.size(); ++k) position.push_back(0.3 - way * std::cos(0.008 * double(k)));
    const RoleSignals signals{position, none, none, none, none, false, {}};
    EffectRun run(compile_effect(effects.front(), {}, axis_sizes(), problems), 1);
    std::vector<EffectRun::Output> output(1);
    const auto compute = [&] { run.run(signals, position.size(), output); };
    if (way < 0.05)
      EXPECT_NO_THROW(compute());
    else
      EXPECT_THROW(compute(), InputError);
    position[20] = std::nan("");  // a motion that diverges is no fault of the effect
    EXPECT_NO_THROW(compute());
  }
}

}  // namespace loopwright::effect_run_again_test
