// How an input went between its rows: what the experiment states is questioned where the record contradicts
// it.
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/compare/compare.h"

namespace loopwright::input_between_rows_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

const char* stated(BetweenRows between) { return names_of(between)[size_t(between)].data(); }

/// An oscillator that lacks nothing, shaken by two smooth tones.
Plant shaken(BetweenRows truth, BetweenRows says) {
  Plant plant = oscillator({}, 41);
  plant.input = [](double t) {
    return 12 * std::sin(2 * std::numbers::pi * 1.3 * t) + 8 * std::sin(9.1 * t + 1);
  };
  plant.between_rows = truth, plant.rows = 1000;
  plant.drive =
      fmt::format(R"("shaker.u": {{"column": "u", "unit": "N", "interpolation": "{}"}})", stated(says));
  return plant;
}
/// A faster one: 10 Hz are 10 rows a turn, in which a straight line is 3 % weaker than the tone.
Plant shaken_fast(BetweenRows says) {
  Plant plant = shaken(BetweenRows::band_limited, says);
  plant.input = [](double t) {
    return 12 * std::sin(2 * std::numbers::pi * 3.3 * t) + 30 * std::sin(2 * std::numbers::pi * 10 * t + 1);
  };
  plant.rows = 1500;
  return plant;
}
Plant with_roles(Plant plant) {
  plant.more =
      R"("roles": {"position": "mass.position", "velocity": "mass.velocity", "force": "net.sum", "input": "shaker.u"})";
  return plant;
}

TEST(InputBetweenRows, LinesThatAreReadAsHeldAreTold) {
  const Diagnosis d = diagnosed(shaken(BetweenRows::linear, BetweenRows::hold));
  EXPECT_THAT(findings(d), Contains(HasSubstr(R"("interpolation": "linear")"))) << to_text(d);
}
TEST(InputBetweenRows, AHeldInputThatIsReadAsLinesIsTold) {
  const Diagnosis d = diagnosed(shaken(BetweenRows::hold, BetweenRows::linear));
  EXPECT_THAT(findings(d), Contains(HasSubstr(R"("interpolation": "hold")"))) << to_text(d);
}
/// What was found beside a wrong statement may stand for it.
TEST(InputBetweenRows, NothingIsExplainedBesideAStatementThatTheRecordContradicts) {
  IS_A_JUDGEMENT();
  Plant plant = shaken(BetweenRows::hold, BetweenRows::linear);
  plant.rate = oscillator({.stiffness = 240}, 41).rate;
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(findings(d), Contains(HasSubstr(R"(first state "interpolation": "hold")"))) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << to_text(d);
}
TEST(InputBetweenRows, ASmoothInputThatIsReadOtherwiseIsTold) {
  IS_A_JUDGEMENT();
  for (const BetweenRows says : {BetweenRows::hold, BetweenRows::linear}) {
    const Diagnosis d = diagnosed(shaken_fast(says));
    EXPECT_THAT(findings(d), Contains(HasSubstr(R"("interpolation": "band_limited")"))) << to_text(d);
  }
}
TEST(InputBetweenRows, WhatIsStatedRightlyIsNotQuestioned) {
  for (const Plant& plant :
       {shaken(BetweenRows::hold, BetweenRows::hold), shaken(BetweenRows::linear, BetweenRows::linear),
        shaken_fast(BetweenRows::band_limited)}) {
    const Diagnosis d = diagnosed(plant);
    EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
    EXPECT_THAT(findings(d), Not(Contains(HasSubstr("interpolation")))) << to_text(d);
  }
}
TEST(InputBetweenRows, OfAnAxisASmoothInputIsFollowedAlongItsCurve) {
  const Diagnosis right = diagnosed(with_roles(shaken_fast(BetweenRows::band_limited)));
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
  EXPECT_LT(right.white_force, 0.06) << "as its process noise";
  const Diagnosis wrong = diagnosed(with_roles(shaken_fast(BetweenRows::hold)));
  EXPECT_NE(wrong.verdict, Verdict::nothing_missing) << to_text(wrong);
}
TEST(InputBetweenRows, ARunFollowsTheSameCurve) {
  const auto error = [](BetweenRows says) {
    Plant plant = with_roles(shaken_fast(says));
    plant.process_noise = {0}, plant.measurement_noise = {0};
    const RecordedPlant files(plant);
    return compare(files.diagram(), files.experiment()).signals.at(0).relative_percent;
  };
  const double smooth = error(BetweenRows::band_limited);
  EXPECT_LT(smooth, 0.05);
  EXPECT_GT(error(BetweenRows::linear), 10 * smooth);
  EXPECT_GT(error(BetweenRows::hold), 100 * smooth);
}

}  // namespace
}  // namespace loopwright::input_between_rows_test
