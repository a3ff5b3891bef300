/// A load behind a stiff spring, whose motion is measured. The record is made by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/tools/diagnose/diagnosed.h"

namespace loopwright::load_side_test {
namespace {

/// At 500 Hz: 0.9 kg, a spring of 170 N/mm, and 1.6 kg with 24 N s/m and 285 N/m^3 x^3, which is hidden and
/// larger than all that is known.
std::string record() {
  constexpr double sample_time = 2e-3, motor = 0.9, load = 1.6, stiffness = 1.7e5, inner = 26, damping = 24,
                   cubic = 285, count = 7e-7;
  constexpr int substeps = 200;
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0, 0.17);
  std::string text = "t,u [N],x [m]\n";
  double x[2] = {}, v[2] = {};
  for (int k = 0; k < 6000; ++k) {
    const double t = k * sample_time, disturbance = noise(random);
    const double u = 25 * std::sin(1.3 * t) + 15 * std::sin(5.1 * t) + 6 * std::sin(23 * t);
    text += fmt::format("{:.6g},{:.12g},{:.12g}\n", t, u, count * std::round(x[1] / count));
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps, shaft = stiffness * (x[0] - x[1]) + inner * (v[0] - v[1]);
      v[0] += h * (u - shaft) / motor;
      v[1] += h * (shaft - damping * v[1] - cubic * x[1] * x[1] * x[1] + disturbance) / load;
      x[0] += h * v[0], x[1] += h * v[1];
    }
  }
  return text;
}

TEST(LoadSide, TheForcesBalanceAlongTheMeasuredMotion) {
  DiagramFolder folder;
  folder.with("axis.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0005, "stop": 12}, "blocks": {
 "u":     {"type": "Constant", "value": {"value": 0, "unit": "N"}},
 "drive": {"type": "Gain", "gain": 1, "in": {"u": "u.y"}},
 "shaft": {"type": "ElasticCoupling", "stiffness": {"value": 1.7e5, "unit": "N/m"}, "damping": {"value": 26, "unit": "N*s/m"},
           "in": {"motor_position": "rotor.position", "motor_velocity": "rotor.velocity",
                  "load_position": "load.position", "load_velocity": "load.velocity"}},
 "left":  {"type": "Sum", "signs": "+-", "in": {"terms": ["drive.y", "shaft.force"]}},
 "rotor": {"type": "Mass", "mass": {"value": 0.9, "unit": "kg"}, "in": {"force": "left.sum"}},
 "vis":   {"type": "ViscousFriction", "damping": {"value": 24, "unit": "N*s/m"}, "in": {"velocity": "load.velocity"}},
 "net":   {"type": "Sum", "signs": "+-", "in": {"terms": ["shaft.force", "vis.force"]}},
 "load":  {"type": "Mass", "mass": {"value": 1.6, "unit": "kg"}, "in": {"force": "net.sum"}}}})");
  folder.with("record.csv", record());
  folder.with("e.json",
              R"({"loopwright": 1, "data": "record.csv", "time": "t", "drive": {"drive.u": {"column": "u"}},
 "compare": {"load.position": {"column": "x", "resolution": "7e-7 m"}},
 "roles": {"position": "load.position", "velocity": "load.velocity", "force": "net.sum", "input": "drive.u"}})");
  const Diagnosis found = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
  EXPECT_THAT(names(found), testing::ElementsAre("hardening_spring")) << to_text(found);
  EXPECT_EQ(found.verdict, Verdict::explained) << to_text(found);
  EXPECT_LT(found.error_after, 1.5 * found.noise_floor);
}

}  // namespace
}  // namespace loopwright::load_side_test
