// How an input went between its rows: what the experiment states is questioned where the record contradicts
// it.
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::input_between_rows_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

/// An oscillator that lacks nothing, shaken by two smooth tones.
Plant shaken(bool draws_lines, bool says_lines) {
  Plant plant = oscillator({}, 41);
  plant.input = [](double t) {
    return 12 * std::sin(2 * std::numbers::pi * 1.3 * t) + 8 * std::sin(9.1 * t + 1);
  };
  plant.draws_lines = draws_lines, plant.rows = 1000;
  if (says_lines) plant.drive = R"("shaker.u": {"column": "u", "unit": "N", "interpolation": "linear"})";
  return plant;
}

TEST(InputBetweenRows, LinesThatAreReadAsHeldAreTold) {
  const Diagnosis d = diagnosed(shaken(true, false));
  EXPECT_THAT(findings(d), Contains(HasSubstr(R"("interpolation": "linear")"))) << to_text(d);
}
TEST(InputBetweenRows, AHeldInputThatIsReadAsLinesIsTold) {
  const Diagnosis d = diagnosed(shaken(false, true));
  EXPECT_THAT(findings(d), Contains(HasSubstr(R"("interpolation": "hold")"))) << to_text(d);
}
TEST(InputBetweenRows, WhatIsStatedRightlyIsNotQuestioned) {
  for (const bool lines : {false, true}) {
    const Diagnosis d = diagnosed(shaken(lines, lines));
    EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
    EXPECT_THAT(findings(d), Not(Contains(HasSubstr("interpolation")))) << to_text(d);
  }
}

}  // namespace
}  // namespace loopwright::input_between_rows_test
