/// Motors whose windings settle within a sample of the record. The records are made by integrations of their
/// own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::fast_pole_test {
namespace {

constexpr double resistance = 3, inductance = 2e-3, constant = 0.9, inertia = 0.02, damping = 0.03;

/// 24 V at 200 Hz, 60000 counts a turn; the winding's time constant is 0.67 ms. `friction`: hidden.
std::string record(double friction) {
  constexpr double sample_time = 5e-3, count = 2 * 3.14159265358979 / 60000;
  constexpr int substeps = 500;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  std::string text = "t,u [V],angle [rad]\n";
  double angle = 0, speed = 0, current = 0;
  for (int k = 0; k < 8000; ++k) {
    const double t = k * sample_time, disturbance = noise(random);
    const double voltage = 8 * std::sin(1.3 * t) + 5 * std::sin(5.1 * t) + 2 * std::sin(23 * t);
    text += fmt::format("{:.6g},{:.12g},{:.12g}\n", t, voltage, count * std::round(angle / count));
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps;
      current += h * (voltage - resistance * current - constant * speed) / inductance;
      speed += h * (constant * current - damping * speed - friction * std::tanh(speed / 1e-3) + disturbance) /
               inertia;
      angle += h * speed;
    }
  }
  return text;
}

Diagnosis diagnosed(double friction) {
  DiagramFolder folder;
  folder.with("motor.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0005, "stop": 1}, "blocks": {
 "u":       {"type": "Constant", "value": {"value": 0, "unit": "V"}},
 "armature": {"type": "Gain", "gain": 1, "in": {"u": "u.y"}},
 "winding": {"type": "Sum", "signs": "+--", "in": {"terms": ["armature.y", "ohmic.y", "emf.y"]}},
 "ohmic":   {"type": "Gain", "gain": {"value": 3, "unit": "ohm"}, "in": {"u": "current.y"}},
 "emf":     {"type": "Gain", "gain": {"value": 0.9, "unit": "V*s/rad"}, "in": {"u": "m.velocity"}},
 "slope":   {"type": "Gain", "gain": {"value": 500, "unit": "A/V/s"}, "in": {"u": "winding.sum"}},
 "current": {"type": "Integrator", "in": {"u": "slope.y"}},
 "torque":  {"type": "Gain", "gain": {"value": 0.9, "unit": "N*m/A"}, "in": {"u": "current.y"}},
 "net":     {"type": "Sum", "signs": "+-", "in": {"terms": ["torque.y", "vis.force"]}},
 "vis":     {"type": "ViscousFriction", "damping": {"value": 0.03, "unit": "N*m*s/rad"}, "in": {"velocity": "m.velocity"}},
 "m":       {"type": "Inertia", "inertia": {"value": 0.02, "unit": "kg*m^2"}, "in": {"torque": "net.sum"}}}})");
  folder.with("record.csv", record(friction));
  folder.with(
      "e.json",
      R"({"loopwright": 1, "data": "record.csv", "time": "t", "drive": {"armature.u": {"column": "u"}},
 "compare": {"m.angle": {"column": "angle", "resolution": "1.0471975511965977e-4 rad"}},
 "roles": {"position": "m.angle", "velocity": "m.velocity", "force": "net.sum", "input": "armature.u"}})");
  return diagnose(folder.path("motor.json"), {folder.path("e.json")}, {});
}

TEST(FastPole, OfAWindingIsFollowed) {
  const Diagnosis found = diagnosed(0);
  EXPECT_EQ(found.verdict, Verdict::nothing_missing) << to_text(found);
}

TEST(FastPole, HidesNoFriction) {
  const Diagnosis found = diagnosed(0.08);
  ASSERT_EQ(found.effects.size(), 1u) << to_text(found);
  EXPECT_THAT(found.effects[0].name, testing::HasSubstr("friction"));
  EXPECT_EQ(found.verdict, Verdict::explained) << to_text(found);
}

}  // namespace
}  // namespace loopwright::fast_pole_test
