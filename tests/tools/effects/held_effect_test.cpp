#include "tools/effects/held_effect.h"
#include <gtest/gtest.h>
#include <cmath>
#include "tests/engine/written_diagram.h"
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::held_effect_test {

namespace {

std::shared_ptr<const EffectPlan> compiled(const Effect& effect) {
  Problems problems;
  auto plan = compile_effect(effect, {}, axis_sizes(), problems);
  EXPECT_EQ(problems.text(), "");
  return plan;
}

/// A late command of which `blocks` are the rest.
std::shared_ptr<const EffectPlan> late(const std::string& blocks, const std::string& from) {
  DiagramFolder folder;
  folder.with("late.json", R"json({
    "loopwright": 1, "effect": "late", "title": "Late", "physics": "It comes late.",
    "parameters": {"delay": {"unit": "s", "range": [0, 0.02], "start": 0.0035}},
    "blocks": {"late": {"type": "FractionalDelay", "delay": "=delay", "samples": 200,
                        "sample_time": "=sample_time", "in": {"u": "input"}})json" +
                               blocks + R"json(},
    "attach": [{"to": "input", "stage": "command", "from": ")json" +
                               from + R"json("}],
    "needs": {"text": "a force that changes"}})json");
  Problems problems;
  const auto effects = load_effect(folder.path("late.json"), problems);
  EXPECT_EQ(problems.text(), "");
  return compiled(effects.at(0));
}

std::vector<double> changing_input(size_t rows) {
  std::vector<double> input;
  for (size_t k = 0; k < rows; ++k)
    input.push_back(std::sin(0.37 * double(k)) + 0.3 * std::cos(0.011 * double(k * k % 977)));
  return input;
}

}  // namespace

TEST(HeldEffect, ALateCommandIsASumOverTheRowsBefore) {
  const auto plan = compiled(effect_named("input_delay"));
  ASSERT_TRUE(plan->is_held);
  const HeldResponse response = *HeldEffect(plan).response({2.25e-3});
  ASSERT_EQ(response.rows.size(), 3u);  // what is asked is taken away, what was asked comes
  EXPECT_EQ(response.rows[0].after, 0u);
  EXPECT_DOUBLE_EQ(response.rows[0].mean, -1);
  EXPECT_EQ(response.rows[1].after, 2u);
  EXPECT_DOUBLE_EQ(response.rows[1].mean, 0.75);
  EXPECT_DOUBLE_EQ(response.rows[1].slope, 6 * 0.25 * 0.75);
  EXPECT_EQ(response.rows[2].after, 3u);
  EXPECT_DOUBLE_EQ(response.rows[2].mean, 0.25);
  EXPECT_DOUBLE_EQ(response.rows[2].slope, -6 * 0.25 * 0.75);
}

TEST(HeldEffect, HasTheColumnsThatAnIntegrationOfEveryRowHas) {
  const auto plan = compiled(effect_named("input_delay"));
  auto integrated = std::make_shared<EffectPlan>(*plan);
  integrated->is_held = false;
  const std::vector<double> input = changing_input(10000);
  const RoleSignals signals{{}, {}, {}, input, {}, false, {}};
  for (const double delay : {0.0, 0.4e-3, 1e-3, 7.3e-3, 20e-3}) {
    std::vector<EffectRun::Output> fast(1), slow(1);
    EffectRun one(plan), other(integrated);
    one.set(0, delay), other.set(0, delay);
    one.run(signals, input.size(), fast), other.run(signals, input.size(), slow);
    for (size_t k = 0; k < input.size(); ++k) {
      ASSERT_NEAR(fast[0].mean[k], slow[0].mean[k], 2e-7) << delay << " " << k;
      ASSERT_NEAR(fast[0].slope[k], slow[0].slope[k], 2e-7) << delay << " " << k;
    }
  }
}

TEST(HeldEffect, WhatDoesNotSuperposeIsNone) {
  EXPECT_TRUE(late("", "late.y")->is_held);
  EXPECT_TRUE(late(R"(, "twice": {"type": "Gain", "gain": 2, "in": {"u": "late.y"}})", "twice.y")->is_held);
  EXPECT_FALSE(
      late(R"(, "most": {"type": "Saturation", "low": -2, "high": 2, "in": {"u": "late.y"}})", "most.y")
          ->is_held);
  for (const Effect& effect : whole_catalogue())
    EXPECT_EQ(compiled(effect)->is_held, effect.name == "input_delay") << effect.name << " " << effect.form;
}

}  // namespace loopwright::held_effect_test
