/// A rotor whose moment of inertia is not as stated. The record is made by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::rotary_inertia_test {
namespace {

struct NoiseOfRecord {
  double angle, torque;  ///< standard deviations [rad, N·m]; the torque is held over each sample
};

/// 1 g·m² and 4 mN·m·s/rad under a current of three sines.
std::string record(const NoiseOfRecord& size) {
  constexpr double inertia = 1e-3, damping = 4e-3, constant = 0.5, sample_time = 1e-3;
  constexpr int substeps = 20;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 1);
  std::string text = "t,i [A],angle [rad]\n";
  double angle = 0, speed = 0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * sample_time,
                 current = 0.5 * std::sin(6.3 * t) + 0.2 * std::sin(31 * t) + 0.1 * std::sin(120 * t);
    text += fmt::format("{:.6g},{:.12g},{:.12g}\n", t, current, angle + size.angle * noise(random));
    const double torque = constant * current + size.torque * noise(random);
    for (int i = 0; i < substeps; ++i) {  // midpoint rule
      const double h = sample_time / substeps, half = speed + h / 2 * (torque - damping * speed) / inertia;
      angle += h * half, speed += h * (torque - damping * half) / inertia;
    }
  }
  return text;
}

/// Of a diagram that states 0.7 g·m².
Diagnosis diagnosed(const NoiseOfRecord& noise) {
  DiagramFolder folder;
  folder.with("axis.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0005, "stop": 6}, "blocks": {
 "kt":  {"type": "Gain", "gain": {"value": 0.5, "unit": "N*m/A"}, "in": {"u": "i.y"}},
 "i":   {"type": "Constant", "value": {"value": 0, "unit": "A"}},
 "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["kt.y", "vis.force"]}},
 "vis": {"type": "ViscousFriction", "damping": {"value": 4, "unit": "mN*m*s/rad"}, "in": {"velocity": "m.velocity"}},
 "m":   {"type": "Inertia", "inertia": {"value": 0.7, "unit": "g*m^2"}, "in": {"torque": "net.sum"}}}})");
  folder.with("record.csv", record(noise));
  folder.with("e.json",
              R"({"loopwright": 1, "data": "record.csv", "time": "t", "drive": {"kt.u": {"column": "i"}},
 "compare": {"m.angle": {"column": "angle"}},
 "roles": {"position": "m.angle", "velocity": "m.velocity", "force": "net.sum", "input": "kt.u"}})");
  return diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
}

TEST(RotaryInertia, IsNamedAndNotTakenForAGain) {
  const Diagnosis found = diagnosed({2e-5, 0});
  ASSERT_EQ(found.effects.size(), 1u);
  EXPECT_EQ(found.effects[0].name, "inertia");
  ASSERT_EQ(found.effects[0].parameters.size(), 1u);
  EXPECT_NEAR(found.effects[0].parameters[0].value, 3e-4, 1e-5);
  EXPECT_EQ(found.verdict, Verdict::explained);
}

TEST(RotaryInertia, LeavesNoForceButThatOfTheNoise) {
  constexpr double torque = 5e-4;
  const Diagnosis found = diagnosed({1e-6, torque});
  ASSERT_EQ(found.effects.size(), 1u);
  EXPECT_NEAR(found.white_force, torque, 0.1 * torque);
  EXPECT_NEAR(found.error_after / found.noise_floor, 1, 0.1);
}

}  // namespace
}  // namespace loopwright::rotary_inertia_test
