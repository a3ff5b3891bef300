// Runs that begin exactly where a decision changes: the crossing function is zero there, and must
// nevertheless have the sign of the side that was decided. References are closed formulas.
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/engine/written_diagram.h"

namespace loopwright::exact_zero_test {
namespace {

using std::numbers::pi;

constexpr std::string_view tight = R"("relative_tolerance": 1e-9, "absolute_tolerance": 1e-11)";

std::string variable(double stop, double row) {
  return fmt::format(R"("method": "dopri5", "stop": {}, "record_step": {}, {})", stop, row, tight);
}

/// Calls check(t, row) for every row.
template <class Check> void each_row(const RunResult& result, Check&& check) {
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  for (size_t i = 0; i < result.recording.rows(); ++i) check(signal(result, "time")[i], i);
}

TEST(ExactZero, ACouplingWithoutAGapPullsTheLoadBackwards) {
  // 2 N on 0.4 kg in all. The load is behind by no more than the deflection of the contact, at most twice the
  // static one of 0.1 kg · 5 m/s² / 2000 N/m.
  const RunResult result =
      run_of(diagram(R"("drive": {"type": "Constant", "value": {"value": -2, "unit": "N"}},
    "coupling": {"type": "BacklashCoupling", "gap": 0, "stiffness": {"value": 2000, "unit": "N/m"}, "damping": 10,
      "in": {"motor_position": "motor.position", "motor_velocity": "motor.velocity", "load_position": "load.position", "load_velocity": "load.velocity"}},
    "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["drive.y", "coupling.force"]}},
    "motor": {"type": "Mass", "mass": 0.3, "in": {"force": "net.sum"}},
    "load": {"type": "Mass", "mass": 0.1, "in": {"force": "coupling.force"}})",
                     variable(1, 0.1)));
  each_row(result, [&](double t, size_t i) {
    const double motor = signal(result, "motor.position")[i], load = signal(result, "load.position")[i];
    EXPECT_NEAR((0.3 * motor + 0.1 * load) / 0.4, -2.5 * t * t, 1e-6) << t;
    EXPECT_NEAR(motor, load, 2 * 0.1 * 5 / 2000) << t;
  });
}

TEST(ExactZero, AMassThatIsLiftedFromTheFloorFallsFreely) {
  // m v' = 20 N - 20 N/s t from rest on the floor: x = 10 t² - 10/3 t³, and back on the floor at 3 s.
  const RunResult result =
      run_of(diagram(R"("lift": {"type": "Constant", "value": {"value": 20, "unit": "N"}},
    "off": {"type": "Ramp", "slope": {"value": 20, "unit": "N/s"}},
    "floor": {"type": "EndStop", "low": 0, "stiffness": {"value": 1000, "unit": "N/m"}, "damping": 60, "in": {"position": "m.position", "velocity": "m.velocity"}},
    "net": {"type": "Sum", "signs": "+--", "in": {"terms": ["lift.y", "off.y", "floor.force"]}},
    "m": {"type": "Mass", "mass": 1, "in": {"force": "net.sum"}})",
                     variable(2.98, 0.02)));
  each_row(result, [&](double t, size_t i) {
    EXPECT_NEAR(signal(result, "m.position")[i], 10 * t * t - 10 * t * t * t / 3, 1e-7) << t;
    EXPECT_EQ(signal(result, "floor.force")[i], 0) << t;
  });
}

TEST(ExactZero, FrictionAtItsBreakawayForceHoldsWhenTheForceFalls) {
  // The force 5 N - 2 N/s t is exactly the friction at the start. It falls, so that the mass rests until the
  // force is -5 N at 5 s. Then v' = (5 - 2 t) + 5 = -2 (t - 5).
  const RunResult result = run_of(diagram(
      R"("fall": {"type": "Ramp", "slope": {"value": -2, "unit": "N/s"}, "initial": {"value": 5, "unit": "N"}},
    "friction": {"type": "CoulombFriction", "level": {"value": 5, "unit": "N"}, "mass": {"value": 1, "unit": "kg"}, "in": {"velocity": "m.velocity", "applied": "fall.y"}},
    "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["fall.y", "friction.force"]}},
    "m": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "net.sum"}})",
      variable(8, 0.25)));
  each_row(result, [&](double t, size_t i) {
    EXPECT_NEAR(signal(result, "m.velocity")[i], -std::pow(std::max(0.0, t - 5), 2), 1e-6) << t;
  });
}

TEST(ExactZero, FrictionOfOneDirectionOnlyDoesNotHoldTheOther) {
  // Without friction forward, m v' = sin t moves forward only: v = 1 - cos t.
  const RunResult result = run_of(
      diagram(R"("push": {"type": "Sine", "amplitude": {"value": 1, "unit": "N"}, "frequency": "=0.5/pi"},
    "friction": {"type": "DirectionDependentFriction", "level_forward": 0, "level_backward": {"value": 5, "unit": "N"}, "damping_forward": 0, "damping_backward": 0, "settling_time": 1,
      "mass": {"value": 1, "unit": "kg"}, "in": {"velocity": "m.velocity", "applied": "push.y"}},
    "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "friction.force"]}},
    "m": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "net.sum"}})",
              variable(6, 0.25)));
  each_row(result, [&](double t, size_t i) {
    EXPECT_NEAR(signal(result, "m.velocity")[i], 1 - std::cos(t), 1e-6) << t;
  });
}

TEST(ExactZero, AnIntegratorAtItsLimitWithoutInputStaysWithinIt) {
  const RunResult below = run_of(diagram(
      R"("u": {"type": "Ramp", "slope": -1}, "tank": {"type": "Integrator", "low": 0, "high": 10, "in": {"u": "u.y"}})",
      variable(2, 0.25)));
  each_row(below, [&](double t, size_t i) { EXPECT_NEAR(signal(below, "tank.y")[i], 0, 1e-12) << t; });
  // u = sin t at the upper limit: it stays there for half a turn, then falls by 2 and comes back.
  const RunResult above = run_of(diagram(
      R"("u": {"type": "Sine", "frequency": "=0.5/pi"}, "tank": {"type": "Integrator", "low": -9, "high": 0, "in": {"u": "u.y"}})",
      variable(9, 0.25)));
  each_row(above, [&](double t, size_t i) {
    EXPECT_NEAR(signal(above, "tank.y")[i], t < pi ? 0 : -1 - std::cos(t), 1e-7) << t;
  });
}

TEST(ExactZero, AResetThatRisesFromZeroActsWhateverStandsBesideIt) {
  // sin(2π t) rises through zero at 0 and at 1 s.
  for (const char* beside :
       {"", R"(, "z": {"type": "ZeroOrderHold", "sample_time": 0.25, "in": {"u": "one.y"}})"}) {
    const RunResult result = run_of(diagram(
        std::string(
            R"("one": {"type": "Constant", "value": 1}, "five": {"type": "Constant", "value": {"value": 5, "unit": "s"}},
      "r": {"type": "Sine", "frequency": 1}, "x": {"type": "Integrator", "in": {"u": "one.y", "reset": "r.y", "reset_value": "five.y"}})") +
            beside,
        variable(1.4, 0.2)));
    each_row(result, [&](double t, size_t i) {
      if (t == 0 || t == 1) return;
      EXPECT_NEAR(signal(result, "x.y")[i], 5 + std::fmod(t, 1), 1e-9) << t << beside;
    });
  }
}

TEST(ExactZero, ARowAtAnEventShowsTheSignalsAfterIt) {
  // x = 3 t reaches 1.5 at 0.5 s, and there is a row. The event is located within its width, not exactly.
  const RunResult result = run_of(diagram(
      R"("three": {"type": "Constant", "value": 3}, "x": {"type": "Integrator", "in": {"u": "three.y"}},
    "half": {"type": "Constant", "value": {"value": 1.5, "unit": "s"}},
    "c": {"type": "Comparison", "operator": ">=", "in": {"a": "x.y", "b": "half.y"}}, "y": {"type": "Integrator", "in": {"u": "c.y"}})",
      R"("method": "dopri5", "stop": 2, "record_step": 0.1)"));
  each_row(result, [&](double t, size_t i) {
    EXPECT_EQ(signal(result, "c.y")[i], t >= 0.5) << t;
    EXPECT_NEAR(signal(result, "y.y")[i], std::max(0.0, t - 0.5), 1e-9) << t;
  });
}

TEST(ExactZero, TheEndOfACamThatIsHeldThereIsLocated) {
  // The natural spline through (0, 0), (0.3, 1), (0.7, 1) has at its middle point the second derivative
  // M = -20/1.4; its integral is Σ h (y₀ + y₁)/2 - Σ h³ M/24. From 0.7 on the position is 1.
  const double bend = -20 / 1.4, integral = 0.15 + 0.4 - (0.027 + 0.064) * bend / 24 + 1.3;
  const RunResult result = run_of(diagram(R"("c": {"type": "Clock"},
    "cam": {"type": "CamTable", "master": [0, 0.3, 0.7], "slave": [0, 1, 1], "ends": "natural", "in": {"position": "c.time"}},
    "i": {"type": "Integrator", "in": {"u": "cam.slave_position"}})",
                                          R"("method": "dopri5", "relative_tolerance": 1e-8, "stop": 2)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(signal(result, "i.y").back(), integral, 1e-8 * integral);
  ASSERT_EQ(result.statistics.events.size(), 1u);
  EXPECT_EQ(result.statistics.events[0].name, "cam.last");
  EXPECT_EQ(result.statistics.events[0].events, 1);
}

TEST(ExactZero, ACamThatBeginsAgainIsAnEventUnlessItIsPeriodic) {
  const auto events = [](const char* ends) {
    const RunResult result = run_of(diagram(fmt::format(R"("c": {{"type": "Clock"}},
      "cam": {{"type": "CamTable", "master": [0, 0.3, 0.7], "slave": [0, 1, 0], "ends": "{}", "cyclic": true, "in": {{"position": "c.time"}}}},
      "i": {{"type": "Integrator", "in": {{"u": "cam.slave_position"}}}})",
                                                        ends),
                                            R"("method": "dopri5", "stop": 3)"));
    EXPECT_EQ(result.status, RunStatus::finished) << result.message;
    int64_t count = 0;
    for (const CrossingCount& crossing : result.statistics.events) count += crossing.events;
    return count;
  };
  EXPECT_EQ(events("natural"), 4) << "at 0.7, 1.4, 2.1 and 2.8 s";
  EXPECT_EQ(events("periodic"), 0);
}

}  // namespace
}  // namespace loopwright::exact_zero_test
