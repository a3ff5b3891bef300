// A lift on a belt whose mode the diagram does not have: what it leaves is neither noise nor an effect of
// its own. The record is made by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/tools/diagnose/diagnosed.h"

namespace loopwright::belt_mode_test {
namespace {

constexpr double rotor = 4e-4, carriage = 8, radius = 0.02, per_ampere = 0.3, gravity = 9.81, damping = 20;
constexpr double count = 2 * M_PI / 8192, current_step = 40.0 / 4096;

/// Strokes of the carriage [s; m].
struct Stroke {
  double begin, end, from, to;
};
constexpr Stroke strokes[] = {{0.5, 1.5, 0, 0.4},      {1.8, 2.4, 0.4, 0.1},    {2.6, 4.6, 0.1, 0.6},
                              {4.8, 5.6, 0.6, 0.2},    {5.8, 6.2, 0.2, 0.3},    {6.3, 9.3, 0.3, 0},
                              {9.5, 10.3, 0, 0.5},     {10.5, 14.5, 0.5, 0.05}, {14.7, 15.4, 0.05, 0.55},
                              {15.5, 16.5, 0.55, 0.1}, {16.6, 18.6, 0.1, 0.4},  {18.8, 19.5, 0.4, 0}};

/// Position and speed that are wanted.
std::pair<double, double> wanted(double t) {
  double at = 0;
  for (const Stroke& s : strokes) {
    if (t < s.begin) return {at, 0};
    const double z = (t - s.begin) / (s.end - s.begin);
    if (z < 1)
      return {s.from + (s.to - s.from) * z * z * z * (10 - 15 * z + 6 * z * z),
              (s.to - s.from) * 30 * z * z * (1 - z) * (1 - z) / (s.end - s.begin)};
    at = s.to;
  }
  return {at, 0};
}

struct Belt {
  double stiffness, inner;
  unsigned seed = 1;  // of the noise of the current
};

/// Current and angle of the motor; the friction is that of the carriage.
std::string record(const Belt& belt) {
  constexpr double sample_time = 1e-3, friction = 14, lag = 8e-4;
  constexpr int substeps = 50;
  std::mt19937_64 random(belt.seed);
  std::normal_distribution<double> noise(0, 0.02);
  std::string text = "t,angle [rad],i [A]\n";
  const double held = carriage * gravity * radius / per_ampere;
  double angle = 0, rate = 0, x = -carriage * gravity / belt.stiffness, v = 0, current = held;
  double integral = held, measured = 0, speed = 0;
  for (int k = 0; k < 20000; ++k) {
    const double before = std::exchange(measured, std::floor(angle / count) * count);
    speed += 0.3 * ((measured - before) / sample_time - speed);
    const auto [way, pace] = wanted(k * sample_time);
    const double error = way / radius - measured;
    integral += 12 * error * sample_time;
    const double command = 1.5 * error + 0.06 * (pace / radius - speed) + integral;
    text += fmt::format("{:.3f},{:.9g},{:.9g}\n", k * sample_time, measured,
                        std::round((current + noise(random)) / current_step) * current_step);
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps;
      current += h * (command - current) / lag;
      const double pull = belt.stiffness * (radius * angle - x) + belt.inner * (radius * rate - v);
      rate += h * (per_ampere * current - radius * pull) / rotor;
      v += h * (pull - carriage * gravity - damping * v - friction * std::tanh(v / 5e-4)) / carriage;
      angle += h * rate, x += h * v;
    }
  }
  return text;
}

Diagnosis diagnosed(const Belt& belt) {
  DiagramFolder folder;
  folder.with(
      "axis.json",
      fmt::format(R"({{"loopwright": 1, "solver": {{"method": "rk4", "step": 0.0005, "stop": 5}}, "blocks": {{
 "i":     {{"type": "Constant", "value": {{"value": 5.232, "unit": "A"}}}},
 "motor": {{"type": "Gain", "gain": {{"value": 0.3, "unit": "N*m/A"}}, "in": {{"u": "i.y"}}}},
 "vis":   {{"type": "ViscousFriction", "damping": {{"value": {}, "unit": "N*m*s"}}, "in": {{"velocity": "shaft.velocity"}}}},
 "weight": {{"type": "ConstantForce", "level": {{"value": {}, "unit": "N*m"}}}},
 "net":   {{"type": "Sum", "signs": "+--", "in": {{"terms": ["motor.y", "vis.force", "weight.force"]}}}},
 "shaft": {{"type": "Inertia", "inertia": {{"value": {}, "unit": "kg*m^2"}}, "in": {{"torque": "net.sum"}}}}}}}})",
                  damping * radius * radius, carriage * gravity * radius,
                  rotor + carriage * radius * radius));
  folder.with("record.csv", record(belt));
  folder.with("e.json", fmt::format(R"({{"loopwright": 1, "data": "record.csv", "time": "t",
 "drive": {{"motor.u": {{"column": "i", "interpolation": "band_limited"}}}},
 "compare": {{"shaft.angle": {{"column": "angle", "resolution": "{} rad"}}}},
 "roles": {{"position": "shaft.angle", "velocity": "shaft.velocity", "force": "net.sum", "input": "motor.u"}},
 "hold_out": {{"fraction": 0.3}}}})",
                                    count));
  return diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
}

/// The mode is as loud as a slow force at the limit of what an amplifier makes. Counted as white noise of the
/// same size it would be far too little for a motion of which counts show the slow part alone: the errors
/// would ask for whatever follows it, and the friction would lose its name to a function that does.
TEST(BeltMode, DoesNotTakeItsNameFromFriction) {
  const Diagnosis found = diagnosed({.stiffness = 6e4, .inner = 60});
  EXPECT_THAT(names(found), testing::ElementsAre("coulomb_friction")) << to_text(found);
  EXPECT_EQ(found.verdict, Verdict::partly_explained) << to_text(found);
}

/// A stiffer belt leaves errors that pass for noise. A little damping or mass makes up for a part of what the
/// forces still leave, which is more than that.
TEST(BeltMode, GivesNoNameToWhatMakesUpForAPartOfIt) {
  const Diagnosis found = diagnosed({.stiffness = 2e5, .inner = 100});
  ASSERT_THAT(names(found), testing::ElementsAre("coulomb_friction")) << to_text(found);
  EXPECT_EQ(found.verdict, Verdict::explained) << to_text(found);
  expect_parameter(found.effects[0], "level", 0.28, 0.005, "N*m");
  EXPECT_THAT(found.refused,
              testing::Contains(testing::Field(&RefusedEffect::why, testing::HasSubstr("beside the noise"))));
}

/// The motor leads the carriage by about a row: all of the current one row later explains as much as a part
/// of that two rows later, and a log that is late would explain more.
TEST(BeltMode, IsNotTakenForALateLog) {
  const Diagnosis found = diagnosed({.stiffness = 6e4, .inner = 60, .seed = 20});
  EXPECT_THAT(findings(found), testing::Not(testing::Contains(testing::HasSubstr("log wrote"))))
      << to_text(found);
}

}  // namespace
}  // namespace loopwright::belt_mode_test
