/// A stage with a known disturbance, run along plateaus of constant velocity, as recordings in a folder.
#pragma once
#include <fmt/format.h>
#include <cmath>
#include <functional>
#include <numbers>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/gp/train.h"

namespace loopwright {

/// V; cogging of 22.5 mm whose amplitude decreases with speed, and drag.
inline double disturbance_at(double x, double v) {
  const double angle = 2 * std::numbers::pi * x / 0.0225;
  return 0.1 + 0.7 * (1 - 0.6 * std::abs(v)) * std::sin(angle + 0.4) + 0.2 * std::sin(2 * angle) - 0.3 * v;
}

class StageFolder : public DiagramFolder {
 public:
  /// One pass: the stage accelerates, keeps each velocity over 0.3 m, and changes within 0.1 s. The label is
  /// the disturbance delayed by `lag`, plus a ripple that is no function of position and velocity.
  StageFolder& pass(const std::string& name, const std::vector<double>& velocities, double lag = 0,
                    const std::function<double(double)>& label = {}) {
    std::string text = time_heading + ",x [mm],v [m/s],d [V]\n";
    std::vector<double> xs, vs;
    double x = 0, v = 0;
    for (double wanted : velocities) {
      for (int k = 0; k < 100; ++k)
        xs.push_back(x), vs.push_back(v + (wanted - v) * k / 100), x += 1e-3 * vs.back();
      v = wanted;
      const double end = x + std::copysign(0.3, v);
      while (v > 0 ? x < end : x > end) xs.push_back(x), vs.push_back(v), x += 1e-3 * v;
    }
    for (size_t k = 0; k < xs.size(); ++k) {
      const size_t then = k - std::min(k, size_t(std::lround(lag * 1000)));
      const double d = label ? label(1e-3 * double(k)) : disturbance_at(xs[then], vs[then]) + ripple(k);
      text +=
          fmt::format("{:.12g},{:.9g},{:.9g},{:.9g}\n", 1e-3 * double(k) / time_unit, 1e3 * xs[k], vs[k], d);
    }
    with(name, text);
    return *this;
  }
  static double ripple(size_t k) { return 0.02 * std::sin(2.4 * double(k) * double(k)); }

  StageFolder& training(const std::string& more = "", const std::string& label = R"({"columns": ["d"]})") {
    with("t.training.json", fmt::format(R"({{
  "loopwright": 1,
  "recordings": ["pass.csv"],
  "position": {{"column": "x"}},
  "velocity": {{"column": "v"}},
  "label": {},
  "velocities": [0.1, 0.2, 0.3, 0.4],
  "velocity_tolerance": 0.001,
  "period": {{"value": 22.5, "unit": "mm"}}{}
}})",
                                        label, more));
    return *this;
  }

  using Set = std::vector<std::pair<std::string, std::string>>;
  std::shared_ptr<const TrainedModel> train(const Set& set = {}) {
    Problems found;
    const auto training = load_training(path("t.training.json"), set, found);
    auto trained = training ? loopwright::train(*training, found) : nullptr;
    said = found.text();
    return trained;
  }
  std::string time_heading = "time [s]";
  double time_unit = 1;  ///< s
  /// The output of the last training.
  std::string said;
};

/// RMS of prediction - disturbance_at() on a grid, V.
inline double error_of(const LearnedModel& learned, double slowest = 0.1, double fastest = 0.4) {
  const gp::Posterior posterior(learned.model);
  double squares = 0;
  int count = 0;
  for (double v = slowest; v <= fastest + 1e-9; v += 0.05)
    for (double x = 0.05; x < 0.9; x += 0.00137, ++count)
      squares += std::pow(posterior.mean({x, v}) - disturbance_at(x, v), 2);
  return std::sqrt(squares / count);
}

}  // namespace loopwright
