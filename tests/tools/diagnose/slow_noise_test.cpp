/// Noise of an amplifier on a record of a low rate: it is forgotten within a few samples. The record is made
/// by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/tools/diagnose/diagnosed.h"

namespace loopwright::slow_noise_test {
namespace {

/// 0.5 kg with 7 N s/m at 200 Hz. A slow force of 18 ms is larger than the white one, which is small at this
/// rate; its density at zero frequency is nine times that of the white one.
std::string record() {
  constexpr double sample_time = 5e-3, mass = 0.5, damping = 7, white = 0.03, slow = 0.033, time = 0.018,
                   count = 1.5e-7;
  constexpr int substeps = 100;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 1);
  const double memory = std::exp(-sample_time / time);
  std::string text = "t,u [N],x [m]\n";
  double x = 0, v = 0, drift = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = k * sample_time, u = 2 * std::sin(2.1 * t) + 1.5 * std::sin(7.3 * t) + std::sin(19 * t);
    text += fmt::format("{:.6g},{:.12g},{:.12g}\n", t, u, count * std::round(x / count));
    drift = memory * drift + slow * std::sqrt(1 - memory * memory) * normal(random);
    const double disturbance = white * normal(random) + drift;
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps;
      v += h * (u - damping * v + disturbance) / mass, x += h * v;
    }
  }
  return text;
}

TEST(SlowNoise, ThatIsForgottenWithinAFewSamplesIsNoise) {
  DiagramFolder folder;
  folder.with("axis.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 10}, "blocks": {
 "u":     {"type": "Constant", "value": {"value": 0, "unit": "N"}},
 "drive": {"type": "Gain", "gain": 1, "in": {"u": "u.y"}},
 "vis":   {"type": "ViscousFriction", "damping": {"value": 7, "unit": "N*s/m"}, "in": {"velocity": "m.velocity"}},
 "net":   {"type": "Sum", "signs": "+-", "in": {"terms": ["drive.y", "vis.force"]}},
 "m":     {"type": "Mass", "mass": {"value": 0.5, "unit": "kg"}, "in": {"force": "net.sum"}}}})");
  folder.with("record.csv", record());
  folder.with("e.json",
              R"({"loopwright": 1, "data": "record.csv", "time": "t", "drive": {"drive.u": {"column": "u"}},
 "compare": {"m.position": {"column": "x", "resolution": "1.5e-7 m"}},
 "roles": {"position": "m.position", "velocity": "m.velocity", "force": "net.sum", "input": "drive.u"}})");
  const Diagnosis found = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
  EXPECT_EQ(found.verdict, Verdict::nothing_missing) << to_text(found);
  EXPECT_NEAR(found.slow_force, 0.033, 0.007);
}

}  // namespace
}  // namespace loopwright::slow_noise_test
