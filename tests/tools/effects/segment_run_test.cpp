#include "tools/effects/segment_run.h"
#include <gtest/gtest.h>
#include <cmath>
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::segment_run_test {

namespace {

/// Strokes back and forth of several speeds, each with a rest behind it in which the position flickers by
/// its last digit.
struct Strokes {
  std::vector<double> position, velocity, acceleration;
  explicit Strokes(int times = 1) {
    for (int i = 0; i < times; ++i) add_strokes();
  }
  void add_strokes() {
    constexpr double period = 1e-3, distance = 0.2;
    for (const double rate : {1.0, 0.4, 1.7, 0.7, 2.3, 0.5})
      for (const double sign : {1.0, -1.0}) {
        const double begin = sign > 0 ? 0.1 : 0.1 + distance, w = 2 * M_PI * rate;
        const int rows = int(0.5 / rate / period);
        for (int k = 0; k < rows + 400; ++k) {
          const double t = std::min(k, rows) * period;
          const double flicker = k > rows ? 1e-9 * (k % 3) : 0;
          position.push_back(begin + sign * 0.5 * distance * (1 - std::cos(w * t)) + flicker);
          velocity.push_back(k < rows ? sign * 0.5 * distance * w * std::sin(w * t) : 0);
          acceleration.push_back(k < rows ? sign * 0.5 * distance * w * w * std::cos(w * t) : 0);
        }
      }
  }
  RoleSignals signals() const { return {position, velocity, acceleration, {}, {}, true, {}}; }
  size_t rows() const { return position.size(); }
};

std::shared_ptr<const EffectPlan> compiled(const std::string& name) {
  Problems problems;
  auto plan = compile_effect(effect_named(name), {}, axis_sizes(), problems);
  EXPECT_EQ(problems.text(), "");
  return plan;
}

std::vector<double> starts_of(const EffectPlan& plan) {
  std::vector<double> starts;
  for (const EffectParameter& p : plan.effect.parameters)
    if (p.is_fitted) starts.push_back(range_of(p, plan.sizes).start);
  return starts;
}

/// Of the record in turn, and of the same in segments if these remember what it does.
struct BothWays {
  bool in_segments;
  std::vector<double> segments, in_turn;
};
BothWays both_ways(const std::string& effect, const std::vector<double>& fitted, const Strokes& strokes) {
  BothWays result{false, {}, std::vector<double>(strokes.rows())};
  const auto plan = compiled(effect);
  EXPECT_TRUE(plan->remembers_way) << effect;
  std::vector<double> slope;
  result.in_segments =
      SegmentRun(plan).run(strokes.signals(), strokes.rows(), fitted, result.segments, slope);
  auto not_in_segments = std::make_shared<EffectPlan>(*plan);
  not_in_segments->remembers_way = false;
  EffectRun run(not_in_segments);
  for (size_t i = 0; i < fitted.size(); ++i) run.set(i, fitted[i]);
  run.run(strokes.signals(), result.in_turn);
  return result;
}

/// One lane has no segments: the record is left to a run in turn.
bool has_lanes() { return widest_instruction_set() != InstructionSet::scalar; }

}  // namespace

TEST(SegmentRun, DryFrictionHasTheBitsOfTheWholeRecordInTurn) {
  for (const char* name : {"coulomb_friction", "stribeck_friction"}) {
    const BothWays both = both_ways(name, starts_of(*compiled(name)), Strokes{});
    EXPECT_EQ(both.in_segments, has_lanes()) << name;
    if (both.in_segments) {
      EXPECT_EQ(both.segments, both.in_turn) << name;
    }
    EXPECT_GT(std::ranges::max(both.in_turn), 0.01) << name;
  }
}

/// The steps of a row are short against the distance: what is left of a reversal must not stay for ever.
TEST(SegmentRun, HysteresisOverAShortWayHasTheBitsOfTheWholeRecordInTurn) {
  const BothWays both = both_ways("presliding_hysteresis", {1, 1e-3}, Strokes(6));
  EXPECT_EQ(both.in_segments, has_lanes());
  if (both.in_segments) {
    EXPECT_EQ(both.segments, both.in_turn);
  }
}

/// Friction that builds up over a tenth of the stroke remembers what was several strokes ago.
TEST(SegmentRun, WhatRemembersALongWayIsLeftToARunInTurn) {
  const Strokes strokes;
  const auto plan = compiled("presliding_hysteresis");
  std::vector<double> fitted = starts_of(*plan);
  constexpr size_t distance = 1;  // after the level
  ASSERT_EQ(fitted.size(), 2u);
  fitted[distance] = 0.06;
  SegmentRun segments(plan);
  std::vector<double> mean, slope;
  EXPECT_FALSE(segments.run(strokes.signals(), strokes.rows(), fitted, mean, slope));
  EffectRun either(plan);
  either.set(distance, 0.06);
  auto not_in_segments = std::make_shared<EffectPlan>(*plan);
  not_in_segments->remembers_way = false;
  EffectRun in_turn(not_in_segments);
  in_turn.set(distance, 0.06);
  std::vector<double> a(strokes.rows()), b(strokes.rows());
  either.run(strokes.signals(), a), in_turn.run(strokes.signals(), b);
  EXPECT_EQ(a, b);
}

TEST(SegmentRun, AShorterWayIsRunInSegmentsAgainAfterSomeRunsInTurn) {
  const Strokes strokes(6);
  SegmentRun segments(compiled("presliding_hysteresis"));
  std::vector<double> mean, slope;
  EXPECT_FALSE(segments.run(strokes.signals(), strokes.rows(), {1, 0.06}, mean, slope));
  bool again = false;
  for (int runs = 1; runs < 100 && !again; ++runs)
    again = segments.run(strokes.signals(), strokes.rows(), {1, 1e-3}, mean, slope);
  EXPECT_EQ(again, has_lanes());
}

TEST(SegmentRun, OnlyWhatRemembersTheWayAloneCanBeRunInSegments) {
  Problems problems;
  for (const Effect& effect : whole_catalogue()) {
    const auto plan = compile_effect(effect, {}, axis_sizes(), problems);
    const bool is_dry = effect.name == "coulomb_friction" || effect.name == "stribeck_friction" ||
                        effect.name == "presliding_hysteresis";
    EXPECT_EQ(plan->remembers_way, is_dry) << effect.name << " " << effect.form;
  }
}

}  // namespace loopwright::segment_run_test
