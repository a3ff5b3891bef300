/// A rotor whose moment of inertia is not as stated. The record is made by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::rotary_inertia_test {
namespace {

/// 1 g·m² and 4 mN·m·s/rad under a current of two sines; the angle with noise of 20 µrad.
std::string record() {
  constexpr double inertia = 1e-3, damping = 4e-3, constant = 0.5, sample_time = 1e-3;
  constexpr int substeps = 20;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 2e-5);
  std::string text = "t,i [A],angle [rad]\n";
  double angle = 0, speed = 0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * sample_time, current = 0.5 * std::sin(6.3 * t) + 0.2 * std::sin(31 * t);
    text += fmt::format("{:.6g},{:.12g},{:.12g}\n", t, current, angle + noise(random));
    for (int i = 0; i < substeps; ++i) {  // midpoint rule
      const double h = sample_time / substeps,
                   half = speed + h / 2 * (constant * current - damping * speed) / inertia;
      angle += h * half, speed += h * (constant * current - damping * half) / inertia;
    }
  }
  return text;
}

TEST(RotaryInertia, IsNamedAndNotTakenForAGain) {
  DiagramFolder folder;
  folder.with("axis.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0005, "stop": 6}, "blocks": {
 "kt":  {"type": "Gain", "gain": {"value": 0.5, "unit": "N*m/A"}, "in": {"u": "i.y"}},
 "i":   {"type": "Constant", "value": {"value": 0, "unit": "A"}},
 "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["kt.y", "vis.force"]}},
 "vis": {"type": "ViscousFriction", "damping": {"value": 4, "unit": "mN*m*s/rad"}, "in": {"velocity": "m.velocity"}},
 "m":   {"type": "Inertia", "inertia": {"value": 0.7, "unit": "g*m^2"}, "in": {"torque": "net.sum"}}}})");
  folder.with("record.csv", record());
  folder.with("e.json",
              R"({"loopwright": 1, "data": "record.csv", "time": "t", "drive": {"kt.u": {"column": "i"}},
 "compare": {"m.angle": {"column": "angle"}},
 "roles": {"position": "m.angle", "velocity": "m.velocity", "force": "net.sum", "input": "kt.u"}})");
  const Diagnosis found = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
  ASSERT_EQ(found.effects.size(), 1u);
  EXPECT_EQ(found.effects[0].name, "inertia");
  ASSERT_EQ(found.effects[0].parameters.size(), 1u);
  EXPECT_NEAR(found.effects[0].parameters[0].value, 3e-4, 1e-5);
  EXPECT_EQ(found.verdict, Verdict::explained);
}

}  // namespace
}  // namespace loopwright::rotary_inertia_test
