// Diagrams that are no numbers beyond the states of the machine, as the root of a level below an empty tank.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::square_root_test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

void put(Plant& plant, const std::string& before, const std::string& after) {
  for (size_t at = 0; (at = plant.diagram.find(before, at)) != std::string::npos; at += after.size())
    plant.diagram.replace(at, before.size(), after);
}
Plant tanks_with_roots(const Tanks& m, uint64_t seed) {
  Plant plant = tanks(m, seed);
  put(plant, "sqrt(abs(h))", "sqrt(h)");
  return plant;
}

TEST(SquareRoot, ACleanTankLacksNothing) {
  const Diagnosis d = diagnosed(tanks_with_roots({}, 61));
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
}
TEST(SquareRoot, WhatATankLosesIsNamed) {
  Tanks m;
  m.lost = [](double level, double) { return 0.02 * std::max(0.0, level - 0.5); };
  const Diagnosis d = diagnosed(tanks_with_roots(m, 62));
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_THAT(terms(d), ElementsAre("balance1.sum: overflow(level1.y)")) << to_text(d);
}
/// Readings of an empty tank are below zero as often as above.
TEST(SquareRoot, ATankThatBeginsEmptyIsFilledWithoutAMissingEffect) {
  Plant plant = tanks_with_roots({}, 63);
  plant.initial = {0, 0};
  put(plant, R"("initial": {"value": 0.3, "unit": "m"})", R"("initial": {"value": 0, "unit": "m"})");
  plant.process_noise = {0, 0}, plant.rows = 600;
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
}
TEST(SquareRoot, WhereADiagramIsNoNumberTheAnswerSaysWhereAndOfWhat) {
  Plant plant = tanks({}, 64);
  put(plant, R"x("formula": "sqrt(abs(h))", "names": ["h"], "in": {"arguments": ["level2.y"]})x",
      R"x("formula": "sqrt(h - 2*abs(h))", "names": ["h"], "in": {"arguments": ["level2.y"]})x");
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_THAT(terms(d), IsEmpty());
  EXPECT_THAT(findings(d), Contains(HasSubstr("at 0 s (row 1), with level1.y = ")));
  EXPECT_THAT(findings(d), Contains(HasSubstr("head2.y is ")));
}

}  // namespace
}  // namespace loopwright::square_root_test
