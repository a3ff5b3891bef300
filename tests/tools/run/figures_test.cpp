// Figures of merit against closed forms of second-order systems.
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "engine/plan/load.h"
#include "models/signal/amplitude_spectrum.h"
#include "tests/engine/written_diagram.h"
#include "tools/run/run_page.h"

namespace loopwright::figures_test {
namespace {

using std::numbers::pi;

/// A step of 2 m at 0.1 s through ω²/(s² + 2 ζ ω s + ω²), sampled finely.
Recording second_order(double damping, double omega = 20, double stop = 3) {
  Recording recording;
  recording.columns = {{"time", "s", {}, ""}, {"r", "m", {}, ""}, {"y", "m", {}, ""}};
  const double damped = omega * std::sqrt(std::abs(1 - damping * damping));
  for (int i = 0; i <= int(stop * 10000); ++i) {
    const double t = i * 1e-4, s = t - 0.1;
    const double y =
        s < 0 ? 0
              : 2 * (1 - std::exp(-damping * omega * s) *
                             (std::cos(damped * s) + damping * omega / damped * std::sin(damped * s)));
    recording.columns[0].values.push_back(t);
    recording.columns[1].values.push_back(s < 0 ? 0 : 2);
    recording.columns[2].values.push_back(y);
  }
  return recording;
}

const FollowedSignal pair{"y", "r", "m", 0, false};

TEST(TrackingFigures, OvershootAndSettlingOfASecondOrderStep) {
  const double damping = 0.3, omega = 20;
  const auto figures = tracking_figures(pair, second_order(damping, omega));
  ASSERT_TRUE(figures && figures->move);
  EXPECT_TRUE(figures->move->is_jump);
  EXPECT_NEAR(figures->move->size, 2, 1e-12);
  EXPECT_NEAR(figures->move->overshoot, 2 * std::exp(-pi * damping / std::sqrt(1 - damping * damping)), 1e-6);
  EXPECT_NEAR(figures->move->band, 0.04, 1e-12);
  // The last time at which the error is 2 %, found by bisection on the closed form between its last two
  // extremes.
  ASSERT_TRUE(figures->move->settling);
  const double damped = omega * std::sqrt(1 - damping * damping);
  const auto error = [&](double s) {
    return std::exp(-damping * omega * s) *
           std::abs(std::cos(damped * s) + damping * omega / damped * std::sin(damped * s));
  };
  double last = 0;
  for (double s = 0; s < 2; s += 1e-5)
    if (error(s) > 0.02) last = s;
  EXPECT_NEAR(*figures->move->settling, last, 2e-4);
  EXPECT_NEAR(figures->greatest, 2, 1e-12);
  EXPECT_NEAR(figures->at, 0.1, 1e-9);
  EXPECT_FALSE(figures->grows);
  // ∫ e² of the closed form: 4 (1 + 4 ζ²)/(4 ζ ω), over 3 s.
  EXPECT_NEAR(figures->rms, std::sqrt(4 * (1 + 4 * damping * damping) / (4 * damping * omega) / 3), 2e-3);
}

TEST(TrackingFigures, AnUnstableLoopGrowsAndNeverSettles) {
  const auto figures = tracking_figures(pair, second_order(-0.05));
  ASSERT_TRUE(figures && figures->move);
  EXPECT_TRUE(figures->grows);
  EXPECT_FALSE(figures->move->settling);
}

TEST(TrackingFigures, AnUndampedLoopDoesNotSettleButDoesNotGrow) {
  const auto figures = tracking_figures(pair, second_order(0));
  ASSERT_TRUE(figures && figures->move);
  EXPECT_FALSE(figures->grows);
  EXPECT_FALSE(figures->move->settling);
}

TEST(TrackingFigures, ADeclaredBandCounts) {
  FollowedSignal wide = pair;
  wide.band = 0.5;
  const auto narrow = tracking_figures(pair, second_order(0.3)),
             loose = tracking_figures(wide, second_order(0.3));
  EXPECT_LT(*loose->move->settling, *narrow->move->settling);
}

constexpr std::string_view servo =
    R"("reference": {"type": "Step", "time": 0.1, "after": {"value": 1, "unit": "m"}},
  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["reference.y", "stage.position"]}},
  "gain": {"type": "Gain", "gain": {"value": 4, "unit": "N/m"}, "in": {"u": "error.sum"}},
  "limit": {"type": "Saturation", "low": {"value": -1, "unit": "N"}, "high": {"value": 1, "unit": "N"}, "in": {"u": "gain.y"}},
  "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "limit.y"}})";
constexpr std::string_view steps = R"("stop": 3, "step": 0.001)";

RunFigures figures_of(const std::string& more, std::vector<std::string>* columns = nullptr) {
  DiagramFolder folder;
  const LoadedDiagram loaded =
      load_diagram_and_plan(folder.with("top.json", diagram(servo, steps, more)).path("top.json"));
  Problems problems;
  const auto followed = followed_signals(*loaded.diagram, *loaded.plan, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  const WatchedLimits watched(*loaded.plan);
  RunResult result = simulate(watched.plan());
  const RunFigures figures = run_figures(followed, result.recording, watched.take(result.recording));
  if (columns)
    for (const Column& column : result.recording.columns) columns->push_back(column.name);
  return figures;
}

TEST(RunFigures, TheReferenceIsGuessedFromADifferenceAndSaid) {
  const RunFigures figures = figures_of("");
  ASSERT_EQ(figures.tracking.size(), 1u);
  EXPECT_EQ(figures.tracking[0].followed.signal, "stage.position");
  EXPECT_TRUE(figures.tracking[0].followed.is_guess);
}

TEST(RunFigures, AreDeclaredInTheDiagram) {
  const RunFigures figures = figures_of(
      R"(, "figures": [{"signal": "stage.position", "reference": "reference.y", "band": {"value": 5, "unit": "cm"}}])");
  ASSERT_EQ(figures.tracking.size(), 1u);
  EXPECT_FALSE(figures.tracking[0].followed.is_guess);
  EXPECT_NEAR(figures.tracking[0].followed.band, 0.05, 1e-15);
}

TEST(RunFigures, MistakesInTheDeclarationAreProblems) {
  EXPECT_THROW(
      figures_of(
          R"(, "log": ["stage.position"], "figures": [{"signal": "stage.position", "reference": "reference.y"}])"),
      InputError);
  EXPECT_THROW(
      figures_of(
          R"(, "figures": [{"signal": "stage.position", "reference": "reference.y", "band": {"value": 5, "unit": "kg"}}])"),
      InputError);
  EXPECT_THROW(figures_of(R"(, "figures": [{"signal": "stage.position"}])"), InputError);
  EXPECT_THROW(figures_of(R"(, "figures": {"signal": "stage.position"})"), InputError);
}

TEST(RunFigures, TimeAtLimitsIsAShareAndLeavesTheRecordingAlone) {
  std::vector<std::string> columns;
  const RunFigures figures = figures_of(R"(, "log": ["stage.position", "reference.y"])", &columns);
  EXPECT_EQ(columns, (std::vector<std::string>{"time", "stage.position", "reference.y"}));
  ASSERT_EQ(figures.limits.size(), 1u);
  EXPECT_EQ(figures.limits[0].block, "limit");
  // The force is 1 N until x = 3/4 m: from 0.1 s on for sqrt(2·0.75/0.5) s.
  EXPECT_NEAR(figures.limits[0].high, std::sqrt(3.0) / 3, 0.002);
}

TEST(AmplitudeSpectrum, OfASineIsItsAmplitudeAtItsFrequency) {
  std::vector<double> values;
  for (int i = 0; i < 4096; ++i) values.push_back(5 + 0.7 * std::sin(2 * pi * 200 * i / 4096));
  const AmplitudeSpectrum s = amplitude_spectrum(values, 1e-3);
  const auto peak = std::ranges::max_element(s.amplitude) - s.amplitude.begin();
  EXPECT_NEAR(s.frequency[size_t(peak)], 200 / 4.096, 1e-9);
  EXPECT_NEAR(s.amplitude[size_t(peak)], 0.7, 1e-6);
}

TEST(Differences, AreTakenOverTheCommonTimeInTheSameUnit) {
  Recording a = second_order(0.3), b = second_order(0.3);
  for (double& y : b.columns[2].values) y += 1e-6;
  for (auto& column : b.columns) column.values.resize(20000);
  b.columns[1].unit = "mm";
  const report::Section section = differences({{"a.csv", &a}, {"b.csv", &b}});
  const auto& table = std::get<report::Table>(section.items.at(0));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"y", "b.csv", "µm", "1", "1", table.rows[0][5]}));
  EXPECT_NE(std::get<report::Notice>(section.items.at(1)).text.find("b.csv has r in mm, not m"),
            std::string::npos);
}

}  // namespace
}  // namespace loopwright::figures_test
