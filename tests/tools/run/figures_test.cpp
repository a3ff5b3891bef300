// Figures of merit against closed forms of second-order systems.
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <numbers>
#include "models/signal/amplitude_spectrum.h"
#include "tests/tools/run/judged_diagram.h"
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
  EXPECT_EQ(figures->move->kind, TrackingFigures::Move::Kind::jump);
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

/// y over rows of 10 ms, with a reference that jumps from 0 to 1 at `jump`.
Recording after_jump(double jump, double stop, const std::function<double(double)>& y) {
  Recording recording;
  recording.columns = {{"time", "s", {}, ""}, {"r", "m", {}, ""}, {"y", "m", {}, ""}};
  for (int i = 0; i <= std::lround(stop * 100); ++i) {
    const double t = i * 0.01;
    recording.columns[0].values.push_back(t);
    recording.columns[1].values.push_back(t < jump ? 0 : 1);
    recording.columns[2].values.push_back(y(t));
  }
  return recording;
}

TEST(TrackingFigures, APassageThroughTheBandAtTheEndIsNotSettling) {
  // The sine is zero at every tenth of a second, so also in the last row; the ramp is at 0.985 there.
  const auto sine =
      tracking_figures(pair, after_jump(0.1, 1, [](double t) { return 1 + std::sin(2 * pi * 5 * t); }));
  const auto ramp = tracking_figures(pair, after_jump(0.1, 1, [](double t) { return 0.985 * t; }));
  ASSERT_TRUE(sine && sine->move && ramp && ramp->move);
  EXPECT_NEAR(sine->last, 0, 1e-12);
  EXPECT_LT(ramp->last, ramp->move->band);
  EXPECT_FALSE(sine->move->settling);
  EXPECT_FALSE(ramp->move->settling);
  // In the band for the last 0.12 s of the 0.9 s after the jump: more than a tenth; for 0.06 s: less.
  const auto from = [](double begin) {
    return tracking_figures(pair, after_jump(0.1, 1, [=](double t) { return t < begin ? 0.5 : 1; }));
  };
  ASSERT_TRUE(from(0.875)->move->settling);
  EXPECT_NEAR(*from(0.875)->move->settling, 0.78, 1e-9);
  EXPECT_FALSE(from(0.935)->move->settling);
}

TEST(TrackingFigures, AStepAtTheStartHasTheFiguresOfALaterStep) {
  // ζ = 0.3, ω = 20 rad/s, seen from the row of the step on, and with 0.1 s before it.
  const Recording later = second_order(0.3);
  Recording at_start = later;
  for (Column& column : at_start.columns)
    column.values.erase(column.values.begin(), column.values.begin() + 1000);
  const auto expected = tracking_figures(pair, later), found = tracking_figures(pair, at_start);
  ASSERT_TRUE(expected && expected->move && found && found->move);
  EXPECT_EQ(found->move->kind, TrackingFigures::Move::Kind::start);
  EXPECT_TRUE(found->is_constant);
  EXPECT_NEAR(found->move->size, 2, 1e-12);
  EXPECT_NEAR(found->move->band, 0.04, 1e-12);
  EXPECT_NEAR(found->move->overshoot, 2 * std::exp(-pi * 0.3 / std::sqrt(1 - 0.09)), 1e-6);
  ASSERT_TRUE(found->move->settling);
  EXPECT_NEAR(*found->move->settling, *expected->move->settling, 2e-4);
}

TEST(TrackingFigures, AnUnstableLoopGrowsAlsoAfterAStepAtTheStart) {
  const auto diverging = [](double rate) {
    return tracking_figures(pair, after_jump(0, 2, [=](double t) { return 1 - std::exp(rate * t); }));
  };
  for (const double rate : {1.0, 3.0, 6.0}) EXPECT_TRUE(diverging(rate)->grows) << rate;
  EXPECT_FALSE(diverging(-1)->grows);
  EXPECT_FALSE(diverging(0)->grows);
}

/// A regulator whose signal begins at the constant reference of 1.
TrackingFigures regulated(double band, const std::function<double(double)>& deviation) {
  FollowedSignal followed = pair;
  followed.band = band;
  return tracking_figures(followed, after_jump(0, 2, [&](double t) { return 1 + deviation(t); })).value();
}

TEST(TrackingFigures, ARegulatorAtAConstantReferenceIsJudgedByItsBand) {
  using Kind = TrackingFigures::Move::Kind;
  // Disturbed from 0.5 s on; below 0.05 after ln(20)/5 s more.
  const auto disturbed = [](double t) { return t < 0.5 ? 0 : std::exp(-5 * (t - 0.5)); };
  EXPECT_FALSE(regulated(0, disturbed).move) << "nobody knows how much is much";
  EXPECT_TRUE(regulated(0, disturbed).is_constant);
  const TrackingFigures back = regulated(0.05, disturbed);
  ASSERT_TRUE(back.move && back.move->settling);
  EXPECT_EQ(back.move->kind, Kind::stay);
  EXPECT_EQ(back.move->size, 0);
  EXPECT_NEAR(*back.move->settling, 0.5 + std::log(20) / 5, 0.011);
  EXPECT_FALSE(regulated(0.05, [](double t) { return t < 0.5 ? 0 : 0.1; }).move->settling);
  EXPECT_EQ(*regulated(0.05, [](double t) { return 0.04 * std::sin(9 * t); }).move->settling, 0);
  // A signal that begins a little off the target has not moved to it when it is disturbed later.
  const TrackingFigures off = regulated(0.05, [&](double t) { return 1e-6 + disturbed(t); });
  ASSERT_TRUE(off.move);
  EXPECT_EQ(off.move->kind, Kind::stay);
}

TEST(TrackingFigures, ADisturbanceThatRisesOrComesInStepsIsNoInstability) {
  const auto grows = [](const std::function<double(double)>& deviation) {
    return regulated(0, deviation).grows || regulated(0.05, deviation).grows;
  };
  EXPECT_FALSE(grows([](double t) { return t; }));
  EXPECT_FALSE(grows([](double t) { return t * t; }));
  EXPECT_FALSE(grows([](double t) { return 1e-6 + std::floor(2 * t) * std::floor(2 * t); }));
}

RunFigures figures_of(const std::string& more) { return judged(limited_servo, more).figures; }

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

TEST(RunAndJudge, RefusesAMistakeInTheFiguresBeforeTheRun) {
  RunOptions options;
  bool has_begun = false;
  options.progress = [&](double, double) { has_begun = true; };
  judged(limited_servo, "", options);
  EXPECT_TRUE(has_begun);
  has_begun = false;
  try {
    judged(limited_servo, R"(, "figures": [{"signal": "stage.positon", "reference": "reference.y"}])",
           options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.problems.text(), "\"stage.positon\" is not logged")) << error.problems.text();
  }
  EXPECT_FALSE(has_begun);
}

TEST(RunAndJudge, SaysWhatIsTrueOfAStepAtTheStart) {
  // Poles of the closed loop at ζ = 0.3, ω = 10 rad/s.
  constexpr std::string_view loop = R"("wanted": {"type": "Step", "after": 1},
  "plant": {"type": "TransferFunction", "numerator": [100], "denominator": [1, 6, 100], "in": {"u": "wanted.y"}})";
  const std::string figures = R"(, "figures": [{"signal": "plant.y", "reference": "wanted.y"}])";
  const std::string text = figures_text(judged(loop, figures).figures);
  EXPECT_TRUE(has(text, "plant.y follows wanted.y, which is constant, with an error of")) << text;
  EXPECT_TRUE(has(text, "it settles within ±0.02 ")) << text;
  EXPECT_TRUE(has(text, "after the start, overshoot 0.37")) << text;  // exp(-π 0.3/√0.91) = 0.3723
  EXPECT_FALSE(has(text, "never comes to rest")) << text;
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
