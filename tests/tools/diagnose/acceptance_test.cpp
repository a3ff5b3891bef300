// An effect stands only if the diagram simulates no worse with it.
#include <gmock/gmock.h>
#include <fstream>
#include <numbers>
#include <nlohmann/json.hpp>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/flawed_axis.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/diagnose/verdict/acceptance.h"
#include "tools/diagnose/verdict/free_run.h"

namespace loopwright::acceptance_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

diagnosis::FreeRun run_of(std::vector<double> squares, bool diverged = false) {
  return {0.1, std::move(squares), diverged};
}

TEST(Acceptance, ARunIsWorseOnlyBeyondTheScatterBetweenWindows) {
  std::vector<double> before, alike, worse;
  for (int i = 0; i < 40; ++i) {
    const double scatter = 0.3 * std::sin(7.0 * i);
    before.push_back(1 + scatter), alike.push_back(1 + 0.3 * std::sin(11.0 * i)),
        worse.push_back(1.2 + scatter);
  }
  EXPECT_FALSE(is_worse(run_of(before), run_of(alike)));
  EXPECT_FALSE(is_worse(run_of(before), run_of(before)));
  EXPECT_TRUE(is_worse(run_of(before), run_of(worse)));
  EXPECT_FALSE(is_worse(run_of(worse), run_of(before)));
  EXPECT_TRUE(is_worse(run_of(before), run_of(before, true)));
}

/// A few windows of fast motion scatter so much that they hide what every window shows.
TEST(Acceptance, ARunIsWorseIfEveryWindowIsWhateverItsSize) {
  std::vector<double> before, after;
  for (int i = 0; i < 40; ++i) {
    const double size = i % 13 == 0 ? 1e4 : 1;
    before.push_back(size), after.push_back(size * (1.5 + 0.3 * std::sin(7.0 * i)));
  }
  EXPECT_TRUE(is_worse(run_of(before), run_of(after)));
  EXPECT_FALSE(is_worse(run_of(after), run_of(before)));
}

/// A delay that is not there improves what is noise a little and spoils every acceleration.
TEST(Acceptance, ARunIsWorseIfSeveralWindowsAreFarWorse) {
  std::vector<double> before, several, one;
  for (int i = 0; i < 80; ++i) {
    before.push_back(1 + 0.8 * std::sin(7.0 * i));
    several.push_back(i % 20 == 3 ? 30 + i : 0.95 * before.back());
    one.push_back(i == 3 ? 100 : 0.95 * before.back());  // an impact that came too late
  }
  EXPECT_TRUE(is_worse(run_of(before), run_of(several)));
  EXPECT_FALSE(is_worse(run_of(before), run_of(one)));
}

/// A false effect may gain from the noise of single rows: the simulation scatters too much to refuse it
/// alone.
TEST(Acceptance, AnEffectThatHelpsNowhereIsRefusedWithoutCertainty) {
  using diagnosis::Errors;
  const Errors before{1.16e-6, 65e-3, 70e-3}, after{1.43e-6, 75e-3, 78e-3};
  EXPECT_TRUE(are_larger(before, after));
  EXPECT_FALSE(are_larger(after, before));
  EXPECT_FALSE(are_larger(before, before));
  EXPECT_FALSE(are_larger(before, Errors{1.1e-6, 75e-3, 78e-3}));   // simulates better
  EXPECT_FALSE(are_larger(before, Errors{1.43e-6, 75e-3, 69e-3}));  // balances what was held out better
  EXPECT_TRUE(are_larger(before, Errors{1.43e-6, 64e-3, 78e-3}));   // better only where it was fitted
  EXPECT_TRUE(are_larger(Errors{1, 1, 0}, Errors{1.1, 1.1, 0}));    // nothing is held out
}

/// Each step of the staircase simulates better, and the last one down to the noise.
TEST(Acceptance, TheStaircaseOfTheSimulationFalls) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.2, truth.cogging = {0.15, 0.024, 0.3};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "cogging")) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained);
  EXPECT_THAT(d.refused, IsEmpty()) << to_text(d);
  for (size_t i = 1; i < d.steps.size(); ++i)
    EXPECT_LT(d.steps[i].simulation_rmse, d.steps[i - 1].simulation_rmse) << to_text(d);
  EXPECT_LT(d.steps.back().simulation_rmse, 0.1 * d.steps.front().simulation_rmse) << to_text(d);
  EXPECT_GT(d.simulation_horizon_s, 0.03);
  EXPECT_LT(d.simulation_horizon_s, 0.3);
}

/// Of a record that holds so much out.
Diagnosis with_hold_out(double fraction) {
  FlawedMachine machine;
  machine.coulomb = 0.6, machine.duration = 5;
  const FlawedAxis axis(machine);
  auto json = nlohmann::json::parse(std::ifstream(axis.experiment()));
  json["hold_out"]["fraction"] = fraction;
  std::ofstream(axis.experiment()) << json.dump();
  return diagnose(axis.diagram(), {axis.experiment()});
}

/// Three stretches at least, or it is told that the simulation has not judged.
TEST(Acceptance, AShortHoldOutIsSimulatedInShorterStretches) {
  const auto are_told_few = testing::Contains(
      testing::Field(&RecordFinding::what, testing::HasSubstr("the rows that are simulated hold")));
  const Diagnosis some = with_hold_out(0.06), few = with_hold_out(0.004);
  EXPECT_THAT(some.findings, testing::Not(are_told_few)) << to_text(some);
  EXPECT_LE(some.simulation_horizon_s, 0.06 * 5 / 8 + 1e-3);
  EXPECT_THAT(few.findings, are_told_few) << to_text(few);
}

/// What the page draws is the axis: each force over its own variable, white errors, and the added blocks.
TEST(Acceptance, ThePlotsShowEachTermAtItsSite) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.2, truth.cogging = {0.15, 0.024, 0.3};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
  const auto largest = [](const std::vector<double>& list) {
    double most = 0;
    for (double v : list) most = std::max(most, std::abs(v));
    return most;
  };
  ASSERT_EQ(d.terms.size(), 2u);
  for (const MissingTerm& term : d.terms) {
    const bool is_cogging = term.effect == "cogging";
    EXPECT_EQ(term.variable, is_cogging ? "Position" : "Velocity");
    EXPECT_NE(term.site, "");
    EXPECT_NEAR(largest(term.shape), is_cogging ? 0.15 : 0.2, 0.015);
    EXPECT_EQ(term.at.size(), term.found.size());
  }
  const auto cogging = std::ranges::find(d.effects, "cogging", &DiagnosedEffect::name);
  const std::vector<DiagnosedParameter> told = told_parameters(*cogging);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0].name, "amplitude");
  EXPECT_NEAR(told[0].value, 0.15, 0.003);
  EXPECT_LT(told[0].high - told[0].low, 0.01);
  EXPECT_EQ(told[1].name, "phase");
  EXPECT_GT(largest(d.whiteness.before), 0.5);
  EXPECT_LT(largest(d.whiteness.after), 3 * d.whiteness.most);
  EXPECT_GE(std::ranges::count(d.picture.nodes, "added", &report::GraphNode::room), 2);
  EXPECT_THAT(report::to_html(diagnosis_page(d)), testing::HasSubstr("over position"));
}

/// Each of the many periods of a short pitch has its crest: wider ranges would draw a beat.
TEST(Acceptance, ThePlotOfCoggingShowsEveryPeriod) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.cogging = {0.15, 0.006, 0.3};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
  ASSERT_EQ(d.terms.size(), 1u) << to_text(d);
  const MissingTerm& term = d.terms.front();
  ASSERT_EQ(term.variable, "Position");
  const auto [low, high] = std::ranges::minmax(term.shape_at);
  int crests = 0;
  for (size_t i = 1; i + 1 < term.shape.size(); ++i)
    crests += term.shape[i] > 0.14 && term.shape[i] > term.shape[i - 1] && term.shape[i] >= term.shape[i + 1];
  EXPECT_NEAR(crests, (high - low) / 0.006, 1.1);
}

/// No effect that is named has an interval with zero in it.
TEST(Acceptance, NoIntervalContainsZero) {
  HiddenAxis axis;
  for (const double drag : {0.0, 0.02, 0.2}) {
    Physics truth = axis.nominal();
    truth.quadratic_n_s2_per_m2 = drag, truth.offset_n = 0.05;
    const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.2, 0.4))});
    for (const DiagnosedEffect& effect : d.effects) {
      if (effect.parameters.size() != 1) continue;
      EXPECT_GT(effect.parameters[0].low * effect.parameters[0].high, 0) << effect.name << "\n" << to_text(d);
    }
  }
}

/// What a window leaves wrong in a load that swings must not go on to the next: it grew from window to
/// window.
TEST(Acceptance, ALoadOnASpringIsSimulatedFromWhereTheMeasuredMotionLedIt) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.load_kg = 0.13, truth.gap_m = -1, truth.coupling_n_per_m = 772, truth.coupling_n_s_per_m = 0.2;
  WantedMotion motion = there_and_back(0.2, 0.4);
  for (int i = 0; i < 3; ++i) {
    const WantedMotion more = there_and_back(0.2, 0.4);
    motion.position.insert(motion.position.end(), more.position.begin(), more.position.end());
  }
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, motion)});
  ASSERT_THAT(names(d), ElementsAre("flexible_mode")) << to_text(d);
  EXPECT_LT(d.steps.back().simulation_rmse, 0.1 * d.steps.front().simulation_rmse) << to_text(d);
}

/// Four rows a pitch at the top speed. What the nominal diagram leaves is white, and as loud as the noise of
/// a bad amplifier.
TEST(Acceptance, AFinePitchIsFoundInWhatLooksLikeNoise) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.cogging = {0.3, 0.0016, 0.3};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("fine", truth, there_and_back(0.2, 0.4))});
  ASSERT_THAT(names(d), ElementsAre("cogging")) << to_text(d);
  const auto pitch = std::ranges::find(d.effects[0].parameters, "pitch", &DiagnosedParameter::name);
  EXPECT_NEAR(pitch->value, 0.0016, 2e-6);
}

/// Cogging 24 times a turn is 24 times a turn, although the record alone says 23.97 or 24.03.
TEST(Acceptance, PitchesOfARotaryAxisAreWholePartsOfATurn) {
  HiddenMachine machine;
  machine.position_unit = "rad", machine.force_unit = "N*m";
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  const double turn = 2 * std::numbers::pi;
  truth.cogging = {0.15, turn / 240, 0.3};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.4, 0.4))});
  ASSERT_THAT(names(d), ElementsAre("cogging")) << to_text(d);
  const auto pitch = std::ranges::find(d.effects[0].parameters, "pitch", &DiagnosedParameter::name);
  ASSERT_NE(pitch, d.effects[0].parameters.end());
  EXPECT_EQ(pitch->times_a_turn, 240);
  EXPECT_DOUBLE_EQ(pitch->value, turn / 240);
  // A gear between motor and encoder: the data contradict a whole number.
  truth.cogging.pitch_m = turn / 240.5;
  const Diagnosis geared = diagnose(axis.diagram(), {axis.record("geared", truth, there_and_back(0.4, 0.4))});
  ASSERT_THAT(names(geared), ElementsAre("cogging")) << to_text(geared);
  const auto free = std::ranges::find(geared.effects[0].parameters, "pitch", &DiagnosedParameter::name);
  EXPECT_EQ(free->times_a_turn, 0);
  EXPECT_NEAR(free->value, turn / 240.5, 1e-5);
}

/// Less damping than stated, and a delay. Without the delay the damping would have to be negative, and no
/// block has that: this says nothing against the two together.
TEST(Acceptance, AStepOfTheStaircaseThatCannotBeRunRefusesNoEffect) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.added_damping_n_s_per_m = -2.4, truth.delay_s = 4e-3;
  WantedMotion motion;
  motion.rest(0.2);
  for (int i = 0; i < 60; ++i) motion.stroke(i % 2 ? -0.02 : 0.02, i % 4 < 2 ? 0.5 : 0.3, 0.05);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, motion)}, {});
  EXPECT_THAT(names(d), testing::UnorderedElementsAre("input_delay", "viscous_friction")) << to_text(d);
  EXPECT_THAT(d.refused, IsEmpty());
}

}  // namespace
}  // namespace loopwright::acceptance_test
