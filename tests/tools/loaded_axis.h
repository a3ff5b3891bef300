/// An axis with a load on a spring, both in the diagram, and records of it from code of its own.
#pragma once
#include <fmt/format.h>
#include <cmath>
#include <random>
#include <string>
#include "tests/engine/written_diagram.h"

namespace loopwright {

/// 0.3 kg driven by sines, 0.2 kg on a spring of 30 Hz.
struct LoadedAxis {
  double damping = 2;                   ///< [N s/m] the diagram has 2
  double origin = 0.7, velocity = 0;    ///< [m, m/s] of both at the first row
  double force_noise = 0, encoder = 0;  ///< [N, m] standard deviations
  int rows = 8000;

  std::string record() const {
    constexpr double motor = 0.3, load = 0.2, sample_time = 1e-3, coupling = 0.5;
    const double stiffness = load * std::pow(2 * 3.14159265358979 * 30, 2);
    constexpr int substeps = 50;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::string text = "t [s],x [m],u [N]\n";
    double x = origin, v = velocity, y = origin, w = velocity;
    for (int k = 0; k < rows; ++k) {
      const double t = k * sample_time, force = 3 * std::sin(5 * t) + 2 * std::sin(17 * t);
      text += fmt::format("{:.6f},{:.12g},{:.12g}\n", t, x + encoder * normal(random), force);
      const double shaken = force + force_noise * normal(random);
      for (int i = 0; i < substeps; ++i) {
        const double h = sample_time / substeps, pull = stiffness * (x - y) + coupling * (v - w);
        v += h * (shaken - damping * v - pull) / motor, w += h * pull / load;
        x += h * v, y += h * w;
      }
    }
    return text;
  }

  /// The files axis.json and e.json.
  void write_to(DiagramFolder& folder) const {
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
    folder.with("record.csv", record());
    folder.with("e.json", R"({"loopwright": 1, "data": "record.csv", "time": "t",
 "drive": {"motor.u": {"column": "u"}}, "compare": {"m.position": {"column": "x"}},
 "roles": {"position": "m.position", "velocity": "m.velocity", "force": "net.sum", "input": "motor.u"}})");
  }
};

}  // namespace loopwright
