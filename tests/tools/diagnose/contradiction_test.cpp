// What speaks against an answer that the predictions alone would take for explained.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/flawed_axis.h"
#include "tools/diagnose/search/prepare.h"
#include "tools/diagnose/verdict/verdict.h"

namespace loopwright::diagnosis::contradiction_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

/// An axis with a constant force that its diagram has too.
class Contradiction : public testing::Test {
 protected:
  Contradiction() {
    constant.name = "constant", constant.linear = {{"level", "N", -1, 1, false, {}}};
    constant.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
      return std::vector(shapes.size(), Columns{Column(std::vector<float>(path.samples(), 1.0F))});
    };
    trials.run_along(Trials::Rows::fitted);
    motion = cut(motion, trials);
    for (Trial& trial : trials.list) inverse.push_back(inverse_dynamics(trial));
    trials.inverse = &inverse;
    conclusion.estimate = fit_members(trials, {{&constant, {1e-3}, {}}}, trials.noise, motion, 1);
    told.effects = {{.name = "constant"}};
    told.steps = {{.force_rmse = 2, .held_out_force_rmse = 2, .simulation_rmse = 1},
                  {.force_rmse = 1, .held_out_force_rmse = 1, .simulation_rmse = 0.5}};
    told.noise_floor = 1, told.holds_out = true, told.mean_square = 1;
  }
  std::vector<std::string> judged() {
    judge(trials, conclusion, motion, search_noise(trials), inverse, told);
    return told.contradictions;
  }

  FlawedAxis axis{FlawedMachine{}};
  Motion motion;
  Trials trials = prepare(axis.diagram(), {axis.experiment()}, {}, motion);
  std::vector<InverseDynamics> inverse;
  Candidate constant;
  Conclusion conclusion;
  Diagnosis told;
};

constexpr const char* held_out = "the residual force of the held-out rows is";
constexpr const char* lost = "no simulation is better with what was found";

TEST_F(Contradiction, IsNoneWhereBothPartsOfTheRecordAreLeftAlike) {
  const std::vector<std::string> why = judged();
  EXPECT_THAT(why, Not(Contains(HasSubstr(held_out))));
  EXPECT_THAT(why, Not(Contains(HasSubstr(lost))));
}
TEST_F(Contradiction, IsAHeldOutForceThatTheFittedRowsDoNotHave) {
  told.steps.back().held_out_force_rmse = 1.5;
  EXPECT_THAT(judged(), Contains(HasSubstr("the residual force of the held-out rows is 1.50 times")));
  EXPECT_NE(told.verdict, Verdict::explained);
}
TEST_F(Contradiction, IsNoHeldOutForceAsLargeAsTheNoise) {
  told.steps.back().held_out_force_rmse = 1.5, told.noise_floor = 1.2;
  EXPECT_THAT(judged(), Not(Contains(HasSubstr(held_out))));
}
TEST_F(Contradiction, IsANameInNoiseAsLoudAsWhatDrivesThatNoSimulationAsksFor) {
  conclusion.estimate.noise.white = 0.5 * trials.force_rms;
  EXPECT_THAT(judged(), Not(Contains(HasSubstr(lost))));
  told.contradictions.clear(), told.steps.back().simulation_rmse = 1.02;
  EXPECT_THAT(judged(),
              Contains(HasSubstr("white noise of the force is 50 % of what drives, and no simulation")));
  told.contradictions.clear(), told.steps.back().simulation_rmse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(judged(), Contains(HasSubstr(lost)));
  EXPECT_NE(told.verdict, Verdict::explained);
}

}  // namespace
}  // namespace loopwright::diagnosis::contradiction_test
