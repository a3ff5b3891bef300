// How the parameters of an effect that was found are told.
#include "tools/diagnose/verdict/found_parameters.h"
#include <gtest/gtest.h>

namespace loopwright::diagnosis::found_parameters_test {
namespace {

/// A level, linear, of 2 ± 0.1 N; and a gap that was looked for from 1 to 4 mm and that no row determines.
Conclusion with_an_undetermined_gap(const Candidate& candidate) {
  Conclusion conclusion;
  conclusion.estimate.members = {{&candidate, {2}, {2e-3}}};
  conclusion.estimate.covariance = Eigen::Vector2d(0.01, 1e12).asDiagonal();
  return conclusion;
}

TEST(FoundParameters, AShapeLiesWithinTheRangeInWhichItWasLookedFor) {
  Candidate candidate;
  candidate.linear = {{"level", "$force", 0, 2.1}};
  candidate.nonlinear = {{"gap", "$position", 1e-3, 4e-3}};
  const std::vector<DiagnosedParameter> told =
      parameters_of_member(with_an_undetermined_gap(candidate), 0, MachineUnits{});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].name, "level");
  EXPECT_NEAR(told[0].high, 2 + 1.96 * 0.1, 1e-12);  // amplitudes are not cut off
  EXPECT_EQ(told[1].low, 1e-3);
  EXPECT_EQ(told[1].high, 4e-3);
}

}  // namespace
}  // namespace loopwright::diagnosis::found_parameters_test
