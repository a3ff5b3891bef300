// What hangs on the axis begins where the measured motion does, and anew with it.
#include <gtest/gtest.h>
#include <fmt/format.h>
#include <cmath>
#include "tests/engine/written_diagram.h"
#include "tools/compare/compare.h"

namespace loopwright::restart_test {
namespace {

constexpr double model_damping = 2;  ///< [N s/m]

/// 0.3 kg driven by sines, 0.2 kg on a spring of 30 Hz, far from the origin.
std::string record(double damping, double velocity) {
  constexpr double motor = 0.3, load = 0.2, sample_time = 1e-3, origin = 0.7;
  const double stiffness = load * std::pow(2 * 3.14159265358979 * 30, 2), coupling = 0.5;
  constexpr int substeps = 50;
  std::string text = "t [s],x [m],u [N]\n";
  double x = origin, v = velocity, y = origin, w = velocity;
  for (int k = 0; k < 8000; ++k) {
    const double t = k * sample_time, force = 3 * std::sin(5 * t) + 2 * std::sin(17 * t);
    text += fmt::format("{:.6f},{:.12g},{:.12g}\n", t, x, force);
    for (int i = 0; i < substeps; ++i) {
      const double h = sample_time / substeps, pull = stiffness * (x - y) + coupling * (v - w);
      v += h * (force - damping * v - pull) / motor, w += h * pull / load;
      x += h * v, y += h * w;
    }
  }
  return text;
}

/// Compared with a model of the damping above.
Comparison compared_with(const std::string& record) {
  DiagramFolder folder;
  folder.with("axis.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0001, "stop": 8}, "blocks": {
 "u":    {"type": "Constant", "value": {"value": 0, "unit": "N"}},
 "net":  {"type": "Sum", "signs": "+--", "in": {"terms": ["motor.y", "vis.force", "spring.force"]}},
 "motor": {"type": "Gain", "gain": 1, "in": {"u": "u.y"}},
 "vis":  {"type": "ViscousFriction", "damping": {"value": 2, "unit": "N*s/m"}, "in": {"velocity": "m.velocity"}},
 "m":    {"type": "Mass", "mass": {"value": 0.3, "unit": "kg"}, "in": {"force": "net.sum"}},
 "spring": {"type": "ElasticCoupling", "stiffness": {"value": 7106.1, "unit": "N/m"}, "damping": {"value": 0.5, "unit": "N*s/m"},
  "in": {"motor_position": "m.position", "motor_velocity": "m.velocity", "load_position": "load.position", "load_velocity": "load.velocity"}},
 "load": {"type": "Mass", "mass": {"value": 0.2, "unit": "kg"}, "in": {"force": "spring.force"}}}})");
  folder.with("record.csv", record);
  folder.with("e.json", R"({"loopwright": 1, "data": "record.csv", "time": "t",
 "drive": {"motor.u": {"column": "u"}}, "compare": {"m.position": {"column": "x"}},
 "roles": {"position": "m.position", "velocity": "m.velocity", "force": "net.sum", "input": "motor.u"}})");
  return compare(folder.path("axis.json"), folder.path("e.json"));
}

TEST(Restart, MovesALoadOnASpringWithTheAxis) {
  const Comparison compared = compared_with(record(model_damping + 0.5, 0));
  ASSERT_TRUE(compared.force) << compared.why_no_force;
  ASSERT_FALSE(compared.force->open_loop.restarted.empty());
  const auto& [horizon, error] = compared.force->open_loop.restarted.front();
  EXPECT_LT(error, 1e-3) << "what the damping leaves within " << horizon << " s";
}

/// The forces are to 3 N; a spring that began slack, or a load at rest, would swing with more than a newton.
TEST(Restart, ALoadBeginsWhereTheRecordDoesAndAsFast) {
  const Comparison compared = compared_with(record(model_damping, 0.4));
  ASSERT_TRUE(compared.force) << compared.why_no_force;
  EXPECT_LT(compared.force->residual.rmse, 0.02);
}

}  // namespace
}  // namespace loopwright::restart_test
