// Comparisons with known results.
#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include "tests/tools/experiment/experiment_folder.h"

namespace loopwright::compare_test {
namespace {

double four(double) { return 4; }
double parabola(double t) { return t * t; }  // 4 N on 2 kg

TEST(Compare, AMeasurementThatFollowsTheModelHasNoError) {
  const Comparison c = ExperimentFolder().data(every(0.05, 41), four, parabola).compared();
  ASSERT_EQ(c.signals.size(), 1u);
  EXPECT_EQ(c.time.size(), 41u);
  EXPECT_EQ(c.signals[0].unit, "m") << "millimetres in the file, metres here";
  EXPECT_NEAR(c.signals[0].measured.back(), 4, 1e-12);
  EXPECT_LT(c.signals[0].max_abs, 1e-12);
  EXPECT_NEAR(c.signals[0].fit_percent, 100, 1e-9);
}

TEST(Compare, KnownErrorsGiveKnownFigures) {
  // The measurement is 1 mm above on one half of the rows and 3 mm above on the other.
  const auto times = every(0.05, 40);
  const Comparison c =
      ExperimentFolder()
          .data(times, four,
                [](double t) { return t * t + (int(std::lround(t / 0.05)) % 2 ? 0.003 : 0.001); })
          .compared();
  const ComparedSignal& s = c.signals[0];
  EXPECT_NEAR(s.mean, -0.002, 1e-12) << "simulated - measured";
  EXPECT_NEAR(s.rmse, std::sqrt((1e-6 + 9e-6) / 2), 1e-12);
  EXPECT_NEAR(s.max_abs, 0.003, 1e-12);
  double mean = 0, square = 0, spread = 0;
  for (double y : s.measured) mean += y / 40, square += y * y / 40;
  for (double y : s.measured) spread += (y - mean) * (y - mean) / 40;
  EXPECT_NEAR(s.relative_percent, 100 * s.rmse / std::sqrt(square), 1e-9);
  EXPECT_NEAR(s.fit_percent, 100 * (1 - s.rmse / std::sqrt(spread)), 1e-9);
}

TEST(Compare, RowsHeldOutAreFiguredApart) {
  const Comparison c =
      ExperimentFolder()
          .experiment(R"("stage.force": {"column": "F", "unit": "N"})",
                      R"("stage.position": {"column": "x_mm", "unit": "mm"})",
                      R"(, "hold_out": {"fraction": 0.25})")
          .data(every(0.05, 40), four, [](double t) { return t * t + (t > 1.48 ? 0.005 : 0); })
          .compared();
  EXPECT_NEAR(c.signals[0].held_out_rmse, 0.005, 1e-12) << "the last ten rows";
}

/// A force that increases by 1 N a second, held from row to row, or joined by straight lines.
double held_ramp(double t) {  // x after the samples before t, each held for 0.05 s
  double x = 0, v = 0;
  for (int k = 0; k < int(std::lround(t / 0.05)); ++k) {
    const double a = 0.05 * k / 2;
    x += v * 0.05 + a * 0.05 * 0.05 / 2, v += a * 0.05;
  }
  return x;
}

TEST(Compare, AHeldDriveAndALinearOneDifferAsTheyShould) {
  const auto ramp = [](double t) { return t; };
  ExperimentFolder folder;
  folder.data(every(0.05, 41), ramp, held_ramp);
  EXPECT_LT(folder.compared().signals[0].max_abs, 1e-12) << "hold is the default";
  folder.experiment(R"("stage.force": {"column": "F", "unit": "N", "interpolation": "linear"})")
      .data(every(0.05, 41), ramp, [](double t) { return t * t * t / 12; });
  EXPECT_LT(folder.compared().signals[0].max_abs, 1e-12);
  folder.experiment(R"("stage.force": {"column": "F", "unit": "N", "interpolation": "hold"})");
  EXPECT_NEAR(folder.compared().signals[0].max_abs, std::abs(held_ramp(2) - 8.0 / 12), 1e-12);
}

TEST(Compare, IrregularTimesAreMetExactlyWhereTheRunHasARow) {
  const Comparison c =
      ExperimentFolder().data({0, 0.1, 0.25, 0.3, 0.7, 1.0, 1.05, 1.9}, four, parabola).compared();
  EXPECT_EQ(c.time.size(), 8u);
  EXPECT_LT(c.signals[0].max_abs, 1e-12);
}

TEST(Compare, ATimeThatBeginsLateStartsTheRunLate) {
  std::vector<double> times = every(0.05, 21);
  for (double& t : times) t += 3;
  const Comparison c =
      ExperimentFolder().data(times, four, [](double t) { return (t - 3) * (t - 3); }).compared();
  EXPECT_EQ(c.time.front(), 3);
  EXPECT_LT(c.signals[0].max_abs, 1e-9);
}

TEST(Compare, OverridesReachTheModel) {
  ExperimentFolder folder;
  folder.data(every(0.05, 21), four, [](double t) { return t * t / 2; });
  LoadOptions heavier;
  heavier.set = {{"stage.payload", "2 kg"}};
  EXPECT_LT(compare(folder.path("stage.json"), folder.path("e.json"), heavier).signals[0].max_abs, 1e-12);
}

TEST(Compare, JsonHasItsStableKeys) {
  const auto json = nlohmann::json::parse(to_json(
      ExperimentFolder().data(every(0.05, 41), four, [](double t) { return t * t + 0.001; }).compared()));
  const auto& signal = json.at("signals").at("stage.position");
  EXPECT_NEAR(signal.at("rmse").get<double>(), 0.001, 1e-12);
  EXPECT_NEAR(signal.at("max_abs").get<double>(), 0.001, 1e-12);
  EXPECT_GT(signal.at("fit_percent").get<double>(), 99);
  EXPECT_EQ(signal.at("unit"), "m");
  EXPECT_EQ(json.at("finished"), true);
  EXPECT_EQ(json.at("rows"), 41);
}

/// Rows k / 400 s, written as `stamp_of` says; a force that is held from row to row pushes 2 kg.
std::string four_hundred_rows_a_second(const std::function<double(int)>& stamp_of) {
  std::string text = "t,F,x_mm\n";
  double x = 0, v = 0;
  constexpr double h = 1.0 / 400;
  for (int k = 0; k < 600; ++k) {
    const double force = 10 * std::sin(0.1 * k);
    text += fmt::format("{:.9g},{:.17g},{:.17g}\n", stamp_of(k), force, 1000 * x);
    x += v * h + force / 2 * h * h / 2, v += force / 2 * h;
  }
  return text;
}

/// The mass of the folder with a step of one row: a held force changes at the beginning of a step only.
ExperimentFolder& with_a_step_a_row(ExperimentFolder& folder) {
  folder.with("stage.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "push.y"}})",
                                    R"("method": "rk4", "step": 0.0025, "stop": 1)"));
  return folder;
}

TEST(Compare, RoundedStampsAreComparedAndDrivenWhereTheSamplesWereTaken) {
  ExperimentFolder folder;
  with_a_step_a_row(folder).with("data.csv",
                                 four_hundred_rows_a_second([](int k) { return std::round(2.5 * k) / 1e3; }));
  const Comparison c = folder.compared();
  ASSERT_EQ(c.time.size(), 600u);
  EXPECT_NEAR(c.time[501], 1.2525, 1e-12) << "1.253 in the file";
  EXPECT_LT(c.signals[0].max_abs, 1e-9);
}

TEST(Compare, StampsThatAreNotOnlyRoundedAreUsedAsTheyAre) {
  ExperimentFolder folder;  // every 7th stamp is 1 ms late: with its rounding more than a digit
  const auto stamp = [](int k) { return std::round(2.5 * k + (k % 7 == 6 ? 1 : 0)) / 1e3; };
  with_a_step_a_row(folder).with("data.csv", four_hundred_rows_a_second(stamp));
  const Comparison c = folder.compared();
  EXPECT_EQ(c.time[6], 0.016);
  EXPECT_EQ(c.time[501], 1.253);
}

TEST(Compare, ColumnsThatNobodyUsesMayHoldText) {
  ExperimentFolder folder;
  std::string text = "t;F;x_mm;note;\n", used = "t;F;x_mm;note;\n";
  for (int k = 0; k < 21; ++k) {
    const double t = 0.05 * k;
    text += fmt::format("{:.17g};4;{:.17g};{};\n", t, 1000 * t * t, k == 0 ? "start" : "");
    used += fmt::format("{:.17g};{};{:.17g};;\n", t, k == 4 ? "off" : "4", 1000 * t * t);
  }
  folder.with("data.csv", text);
  EXPECT_LT(folder.compared().signals[0].max_abs, 1e-12);
  folder.with("data.csv", used);
  EXPECT_NE(folder.refusal().find("data.csv:6:21: error: column \"F\": text where a number should be"),
            std::string::npos)
      << folder.refusal();
}

/// The square root of a negative time ends the run.
std::string stage_that_fails_after_one_second() {
  return diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}}, "t": {"type": "Clock"},
    "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "push.y"}},
    "end": {"type": "Constant", "value": {"value": 1.02, "unit": "s"}},
    "bad": {"type": "Expression", "formula": "sqrt(end-t) * 1", "names": ["end", "t"], "in": {"arguments": ["end.y", "t.time"]}})",
                 R"("step": 0.05, "stop": 1)");
}

TEST(Compare, HeldOutRowsThatTheRunDidNotReachHaveNoError) {
  ExperimentFolder folder;
  folder.experiment(R"("stage.force": {"column": "F", "unit": "N"})",
                    R"("stage.position": {"column": "x_mm", "unit": "mm"})",
                    R"(, "hold_out": {"fraction": 0.3})");
  // The figure of all rows stands in the text, too.
  folder.data(every(0.05, 40), four, [](double t) { return t * t + (t > 1.38 ? 0.005 : 0); });
  const std::string text = to_text(folder.compared());
  EXPECT_NE(text.find("held out, rms\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" 5 mm\n"), std::string::npos) << text;
  folder.with("stage.json", stage_that_fails_after_one_second());
  folder.data(every(0.05, 41), four, [](double t) { return t * t + 0.005; });
  const Comparison c = folder.compared();
  EXPECT_EQ(c.run.status, RunStatus::failed);
  EXPECT_GT(c.signals[0].rmse, 0);
  EXPECT_EQ(c.signals[0].held_out_rmse, 0) << "rows from 1.4 s are held out, and it ended at 1 s";
  EXPECT_TRUE(c.lacks_held_out);
  EXPECT_NE(to_text(c).find("no error of theirs is given"), std::string::npos);
  EXPECT_FALSE(
      nlohmann::json::parse(to_json(c)).at("signals").at("stage.position").contains("held_out_rmse"));
}

TEST(Compare, AFailedRunIsComparedAsFarAsItCameAndSaysSo) {
  ExperimentFolder folder;
  folder.with("stage.json", stage_that_fails_after_one_second());
  const Comparison c = folder.data(every(0.05, 41), four, parabola).compared();
  EXPECT_EQ(c.run.status, RunStatus::failed);
  EXPECT_GE(c.time.size(), 20u);
  EXPECT_LT(c.time.size(), 23u);
  EXPECT_LT(c.signals[0].max_abs, 1e-12);
}

}  // namespace
}  // namespace loopwright::compare_test
