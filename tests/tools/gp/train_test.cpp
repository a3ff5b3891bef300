#include "tools/gp/train.h"
#include <gmock/gmock.h>
#include "tests/tools/gp/stage.h"
#include "tools/gp/gp_page.h"

namespace loopwright::train_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::vector<double> four{0.1, 0.2, 0.3, 0.4};

TEST(Train, LearnsTheDisturbanceThatIsThere) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "kernel": "product")");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_LT(error_of(trained->learned), 0.01) << "between the trained velocities too";
  EXPECT_NEAR(trained->learned.model.kernel.noise, 0.02 / std::sqrt(2), 0.002);
  EXPECT_TRUE(trained->learned.warnings.empty()) << trained->learned.warnings.front();
  EXPECT_TRUE(trained->is_structured);
}

TEST(Train, TakesTimeInTheUnitOfItsHeading) {
  StageFolder folder;
  folder.time_heading = "t [ms]", folder.time_unit = 1e-3;
  folder.pass("pass.csv", four).training(R"(, "kernel": "product", "window_length": 0.2)");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_LT(error_of(trained->learned), 0.01);
  EXPECT_NEAR(trained->samples->sections.front().to - trained->samples->sections.front().from, 2, 0.01)
      << "0.2 m at 0.1 m/s";
}

TEST(Train, ANominalMassMustMakeOfMotionWhatTheCommandIs) {
  StageFolder folder;
  const char* const label =
      R"({"command": "d", "mass": {"value": 2, "unit": "kg"}, "damping": {"value": 3, "unit": "V*s/m"}, "cutoff": 900})";
  folder.pass("pass.csv", four).training("", label);
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said, AllOf(HasSubstr("the nominal mass does not fit the command"), HasSubstr("N")));
  EXPECT_THAT(folder.said, Not(HasSubstr("damping")));
}

TEST(Train, AVelocityIsThePositionPerTime) {
  const auto said = [](const std::string& position, const std::string& velocity) {
    StageFolder folder;
    std::string text = fmt::format("time [s],x [{}],v [{}],d [V]\n", position, velocity);
    for (int k = 0; k < 20; ++k) text += fmt::format("{},{},{},0\n", 1e-3 * k, 1e-3 * k, 1);
    folder.with("pass.csv", text);
    folder.training().train();
    return folder.said;
  };
  for (const char* velocity : {"1/min", "Hz", "mm/s"})
    EXPECT_THAT(said("rad", velocity),
                AllOf(HasSubstr("the velocity does not fit the position"), HasSubstr("a velocity in rad/s")));
  for (const char* velocity : {"rpm", "1/s", "deg/s"})
    EXPECT_THAT(said("rad", velocity), Not(HasSubstr("does not fit the position")));
  EXPECT_THAT(said("mm", "m/min"), Not(HasSubstr("does not fit the position")));
}

TEST(Train, AUnitThatContradictsTheHeadingIsAnError) {
  StageFolder folder;
  folder.pass("pass.csv", four).training("", R"({"columns": ["d"], "unit": "mV"})");
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said, AllOf(HasSubstr("another unit in its file"), HasSubstr("[V] in "),
                                 HasSubstr("pass.csv:1:"), HasSubstr("mV")));
}

TEST(Train, KeepsToItsWindowsAboutTheMiddleOfEachSection) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "window_length": {"value": 125, "unit": "mm"})");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  ASSERT_EQ(trained->samples->sections.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const auto& section = trained->samples->sections[i];
    EXPECT_NEAR(section.high - section.low, 0.125, 0.0009);  // two steps of 0.4 m/s
    EXPECT_NEAR(double(section.count), 125 / four[i], 2);
  }
}

TEST(Train, WindowsMayHaveCentersOfTheirOwn) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "window_length": 0.1, "window_centers": [0.1, 0.5, 0.8, 1.1])");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_NEAR(trained->samples->sections[1].low, 0.45, 0.001);
  EXPECT_NEAR(trained->samples->sections[1].high, 0.55, 0.001);
}

TEST(Train, TakesTheLagOutOfTheLabels) {
  StageFolder folder;
  folder.pass("pass.csv", four, 0.008).training(R"(, "kernel": "product")");
  const auto late = folder.train(), corrected = folder.train({{"label.lag", "0.008"}});
  ASSERT_TRUE(late && corrected) << folder.said;
  EXPECT_GT(error_of(late->learned), 0.1);
  EXPECT_LT(error_of(corrected->learned), 0.01);
  EXPECT_EQ(corrected->learned.model.label_lag, 0.008);
}

TEST(Train, AddsUpColumnsOfTheDisturbance) {
  StageFolder folder;
  folder.pass("pass.csv", four).training("", R"({"columns": ["d", "d"]})");
  const auto twice = folder.train();
  folder.training();
  const auto once = folder.train();
  ASSERT_TRUE(twice && once) << folder.said;
  EXPECT_NEAR(twice->learned.model.label_mean, 2 * once->learned.model.label_mean, 1e-12);
}

TEST(Train, FindsThePeriodWhenToldTo) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto trained = folder.train({{"period", "22.9 mm"}, {"fit_period", "true"}});
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_NEAR(trained->learned.model.kernel.terms[0].along[0].period, 0.0225, 3e-6);
}

TEST(Train, TakesPositionsFromTheHomingOffset) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto homed = folder.train(), moved = folder.train({{"homing_offset", "0.003"}});
  ASSERT_TRUE(homed && moved) << folder.said;
  EXPECT_NEAR(gp::Posterior(moved->learned.model).mean({0.2, 0.2}),
              gp::Posterior(homed->learned.model).mean({0.203, 0.2}), 1e-6);
  EXPECT_EQ(moved->learned.model.homing_offset, 0.003);
}

TEST(Train, ThinsEvenly) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto all = folder.train(), some = folder.train({{"most_samples", "500"}});
  ASSERT_TRUE(all && some) << folder.said;
  EXPECT_EQ(some->learned.sample_count, 500u);
  EXPECT_EQ(some->samples->sections.size(), 4u);
  EXPECT_NEAR(error_of(some->learned), error_of(all->learned), 0.01);
  EXPECT_NE(some->learned.data_hash, all->learned.data_hash);
}

TEST(Train, FallsBackToTheWholeMatrixAndSaysSo) {
  StageFolder folder;
  folder.pass("pass.csv", four)
      .training(
          R"(, "kernel": "terms", "terms": [{"position": "periodic"}, {"position": "squared_exponential"}], "most_samples": 150)");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_FALSE(trained->is_structured);
  EXPECT_THAT(trained->notes, Contains(HasSubstr("whole matrix of 150 samples, because the terms see the "
                                                 "position in different ways")));
  EXPECT_FALSE(folder.train({{"most_samples", "0"}}));
  EXPECT_THAT(folder.said, AllOf(HasSubstr("no structure"), HasSubstr("most_samples")));
}

TEST(Train, GivesTheSameModelAgain) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto first = folder.train(), second = folder.train();
  EXPECT_EQ(first->learned.model.kernel, second->learned.model.kernel);
  EXPECT_EQ(first->learned.data_hash, second->learned.data_hash);
}

/// A plant that obeys d = M a + B v - u exactly: the label must be its disturbance, without lag.
TEST(Train, FindsTheDisturbanceInCommandAndPosition) {
  const double mass = 0.26, damping = 3, step = 1e-3;
  const int fine = 200;
  std::string text = "time [s],x [m],v [m/s],u [V]\n";
  double x = 0, v = 0, u = 0;
  for (int k = 0; k < 6000; ++k) {
    // A controller that keeps four velocities well, with its own noise.
    const double wanted = four[size_t(k / 1500)];
    u = 60 * (wanted - v) + damping * wanted;
    text += fmt::format("{:.3f},{:.12g},{:.12g},{:.12g}\n", step * k, x, wanted, u);
    for (int i = 0; i < fine; ++i) {
      const double h = step / fine, a = (u - damping * v + disturbance_at(x, v)) / mass;
      x += h * (v + 0.5 * h * a), v += h * a;
    }
  }
  StageFolder folder;
  folder.with("pass.csv", text);
  folder.training(R"(, "kernel": "product", "settling": 0.1)",
                  R"({"command": "u", "mass": 0.26, "damping": 3, "cutoff": "=2*pi*150"})");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_LT(error_of(trained->learned), 0.02);
}

TEST(Warnings, APeriodThatIsAFifthWrongIsFoundOut) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  for (const char* wrong : {"18 mm", "27 mm"}) {
    const auto trained = folder.train({{"period", wrong}});
    ASSERT_TRUE(trained) << folder.said;
    EXPECT_THAT(trained->learned.warnings,
                Contains(AllOf(HasSubstr("a period of 22.5"), HasSubstr("probably wrong"))));
  }
}

TEST(Warnings, OneVelocitySaysNothingOfOthers) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto trained = folder.train({{"velocities", "[0.2]"}});
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_THAT(trained->learned.warnings, Contains(HasSubstr("one velocity only, 0.2 m/s")));
}

TEST(Warnings, AVelocityThatNoSectionKeepsIsNamed) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto trained = folder.train({{"velocities", "[0.2, 0.3, 0.7]"}});
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_THAT(trained->learned.warnings, Contains(HasSubstr("no section of the recordings keeps 0.7 m/s")));
}

TEST(Warnings, AParameterAtItsLimitIsNamed) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "priors": [{"parameter": "noise", "low": 0.1}])");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_THAT(trained->learned.warnings, Contains(HasSubstr("noise ended at its limit: 0.1")));
}

TEST(Warnings, ACollapsedLengthIsNamed) {
  StageFolder folder;
  folder.pass("pass.csv", four)
      .training(R"(, "priors": [{"parameter": "terms.1.velocity.length", "low": 0.001, "high": 0.02}])");
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_THAT(trained->learned.warnings,
              Contains(AllOf(HasSubstr("along the velocity collapsed"), HasSubstr("plateau"))));
}

TEST(Warnings, NoiseAloneIsNoModel) {
  StageFolder folder;
  folder.pass("pass.csv", four, 0, [](double t) { return std::sin(1e4 * t * t); }).training();
  const auto trained = folder.train();
  ASSERT_TRUE(trained) << folder.said;
  EXPECT_THAT(trained->learned.warnings, Contains(HasSubstr("% of the labels' variance only")));
}

TEST(BadInput, FewSamplesAreRefused) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "most_samples": 30)");
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said,
              AllOf(HasSubstr("too few samples"), HasSubstr("at least 50"), HasSubstr("30 samples")));
}

TEST(BadInput, ConstantLabelsAreRefused) {
  StageFolder folder;
  folder.pass("pass.csv", four, 0, [](double) { return 0.5; }).training();
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said, AllOf(HasSubstr("labels do not vary"), HasSubstr("0.5 in all")));
}

TEST(BadInput, ANanIsPlaced) {
  StageFolder folder;
  folder.pass("pass.csv", four, 0, [](double t) { return t == 0.5 ? std::nan("") : t; }).training();
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said, AllOf(HasSubstr("pass.csv:502:"), HasSubstr("nan")));
}

TEST(BadInput, AVelocityThatWasNeverDrivenIsAnswerdWithThoseThatWere) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  EXPECT_FALSE(folder.train({{"velocities", "[0.77]"}}));
  EXPECT_THAT(folder.said, AllOf(HasSubstr("no sample"), HasSubstr("velocities from 0 to 0.4 m/s")));
}

TEST(BadInput, AllMistakesOfAFileAreToldAtOnceWithTheirPlaces) {
  StageFolder folder;
  folder.pass("pass.csv", four);
  folder.with("t.training.json", R"({
  "loopwright": 1,
  "recordings": ["pass.csv"],
  "positon": {"column": "x"},
  "label": {"columns": "d"},
  "period": {"value": 3, "unit": "s"},
  "kernel": "pe"
})");
  EXPECT_FALSE(folder.train());
  EXPECT_THAT(folder.said,
              AllOf(HasSubstr("t.training.json:4:"), HasSubstr("did you mean \"position\"?"),
                    HasSubstr(":5:"), HasSubstr("a list"), HasSubstr(":6:"), HasSubstr("another unit"),
                    HasSubstr(":7:"), HasSubstr("\"ps\", \"ds\", \"product\" or \"terms\"")));
}

TEST(BadInput, FilesAndColumnsThatAreNotThereAreNamed) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  EXPECT_FALSE(folder.train({{"position.column", "xx"}}));
  EXPECT_THAT(folder.said, HasSubstr("pass.csv: the data have no column \"xx\""));
  EXPECT_FALSE(folder.train({{"recordings", "[\"other.csv\"]"}}));
  EXPECT_THAT(folder.said, AllOf(HasSubstr("\"other.csv\" is not there"), HasSubstr("expected")));
}

TEST(BadInput, WhatDoesNotFitTogetherIsRefused) {
  StageFolder folder;
  folder.pass("pass.csv", four).training();
  const auto refused = [&](const StageFolder::Set& set) {
    EXPECT_FALSE(folder.train(set));
    return folder.said;
  };
  EXPECT_THAT(refused({{"period", "0"}}), HasSubstr("period of the disturbance is missing"));
  EXPECT_THAT(refused({{"kernel", "terms"}}), HasSubstr("\"terms\" belong to"));
  EXPECT_THAT(refused({{"window_centers", "[0.1]"}}), HasSubstr("one center a velocity"));
  EXPECT_THAT(refused({{"label.command", "u"}}), HasSubstr("either from columns or from the command"));
  EXPECT_THAT(refused({{"velocities", "[0]"}}), HasSubstr("nothing moves"));
  EXPECT_THAT(refused({{"priors", R"([{"parameter": "nois"}])"}}), HasSubstr("did you mean \"noise\"?"));
}

TEST(ModelPage, TellsHyperParametersResidualsAndDoubts) {
  StageFolder folder;
  folder.pass("pass.csv", four).training(R"(, "title": "A stage")");
  const auto trained = folder.train({{"period", "18 mm"}});
  ASSERT_TRUE(trained) << folder.said;
  const ShownSamples own{"training", trained->samples->samples,
                         score(trained->learned.model, trained->samples->samples)};
  const std::string html = report::to_html(model_page(trained->learned, {own}, trained->notes));
  for (const char* part : {"A stage", "PE(x) + SE(v)", "terms.0.position.length", "probably wrong",
                           "Residuals", "<polygon", "<circle", "Log evidence"})
    EXPECT_THAT(html, HasSubstr(part));
  const std::string json = model_json(trained->learned, {own});
  for (const char* part :
       {"\"hyper_parameters\"", "\"terms.1.velocity.length\"", "\"scores\"", "\"slope_bounds\""})
    EXPECT_THAT(json, HasSubstr(part));
  EXPECT_THAT(model_summary(trained->learned, {own}), HasSubstr("warning: a period of"));
}

}  // namespace
}  // namespace loopwright::train_test
