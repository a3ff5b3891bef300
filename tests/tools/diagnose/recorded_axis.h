/// Records of a synthetic axis in closed loop, with a force that the diagram beside them lacks.
#pragma once
#include <unistd.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include "models/random/philox.h"

namespace loopwright {

/// What the truth contains beyond the diagram's mass of 0.2621 and damping of 3.
struct Truth {
  double mass = 0.2621, damping = 3;
  std::function<double(double position, double velocity, double time)> force = [](double, double, double) {
    return 0.0;
  };
  double duration_s = 12;
  bool returns = true;
  double noise = 0.01;  ///< force, held over a sample
  std::string position_unit = "m", force_unit = "N";
  uint64_t seed = 1;
};

/// Folder with nominal.json, train.csv and train.experiment.json; removed with the object.
class RecordedAxis {
 public:
  explicit RecordedAxis(const Truth& truth) : truth_(truth) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        fmt::format("recorded_axis_{}_{}_{}_{}", getpid(), test->test_suite_name(), test->name(), truth.seed);
    std::filesystem::create_directories(folder_);
    record();
    write_diagram(), write_experiment("train"), write_data("train");
  }
  ~RecordedAxis() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  std::string diagram() const { return (folder_ / "nominal.json").string(); }
  std::string experiment() const { return (folder_ / "train.experiment.json").string(); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Changes the recorded numbers, then writes them again.
  void spoil(const std::function<void(std::vector<double>& force, std::vector<double>& position)>& how) {
    how(force_, position_);
    write_data("train");
  }

 private:
  double gauss(uint64_t stream, uint64_t index) const {
    const UniformPair u = uniform_pair(truth_.seed, stream, index);
    return std::sqrt(-2 * std::log(u.first)) * std::cos(2 * std::numbers::pi * u.second);
  }
  /// Strokes of 0.3 with seven peak speeds from 0.05 to 0.4, forward and back.
  void reference(double t, double& x, double& v, double& a) const {
    const double peaks[] = {0.4, 0.1, 0.25, 0.05, 0.35, 0.15, 0.2};
    double begin = 0.2, from = 0;
    x = v = a = 0;
    for (int i = 0; i < 100; ++i) {
      const double peak = peaks[i % 7], way = 0.3, time = 2 * way / peak, w = 2 * std::numbers::pi / time;
      const double to = truth_.returns && i % 2 ? from - way : from + way;
      if (t < begin) return void(x = from);
      if (t < begin + time) {
        const double s = t - begin, sign = to > from ? 1 : -1;
        x = from + sign * way * (s / time - std::sin(w * s) / (2 * std::numbers::pi));
        v = sign * way / time * (1 - std::cos(w * s));
        a = sign * way / time * w * std::sin(w * s);
        return;
      }
      begin += time + 0.05, from = to;
    }
  }
  void record() {
    constexpr double period = 1e-3;
    constexpr int substeps = 20;
    double x = 0, v = 0, last = 0, slow = 0;
    const size_t rows = size_t(truth_.duration_s / period);
    for (size_t k = 0; k < rows; ++k) {
      const double t = double(k) * period;
      double wanted_x, wanted_v, wanted_a;
      reference(t, wanted_x, wanted_v, wanted_a);
      const double seen = std::round((x + 5e-8 * gauss(2, k)) / 2e-7) * 2e-7;
      const double u = 0.2621 * wanted_a + 3 * wanted_v + 3000 * (wanted_x - seen) +
                       45 * (wanted_v - (seen - last) / period);
      last = seen;
      force_.push_back(u), position_.push_back(seen);
      slow = 0.967 * slow + 0.3 * truth_.noise * std::sqrt(1 - 0.967 * 0.967) * gauss(3, k);
      const double push = u + truth_.noise * gauss(1, k) + slow;
      for (int i = 0; i < substeps; ++i) {
        const double h = period / substeps;
        const auto rate = [&](double at_x, double at_v) {
          return (push - truth_.damping * at_v - truth_.force(at_x, at_v, t + i * h)) / truth_.mass;
        };
        const double half = v + 0.5 * h * rate(x, v);
        const double middle = rate(x + 0.5 * h * v, half);
        x += h * half, v += h * middle;
      }
    }
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  void write_data(const std::string& name) const {
    std::string text = "t_s,force,position\n";
    for (size_t k = 0; k < force_.size(); ++k)
      text += fmt::format("{:.3f},{:.9g},{:.9g}\n", double(k) * 1e-3, force_[k], position_[k]);
    write(name + ".csv", text);
  }
  void write_diagram() const {
    const std::string x = truth_.position_unit, f = truth_.force_unit;
    write("nominal.json", fmt::format(R"({{
  "loopwright": 1,
  "title": "An axis, nominal",
  "solver": {{"method": "rk4", "step": 0.001, "stop": 12}},
  "blocks": {{
    "force":     {{"type": "Constant", "value": {{"value": 0, "unit": "{1}"}}}},
    "motor":     {{"type": "Gain", "gain": 1, "in": {{"u": "force.y"}}}},
    "viscous":   {{"type": "ViscousFriction", "damping": {{"value": 3, "unit": "{1}*s/{0}"}}, "in": {{"velocity": "mass.velocity"}}}},
    "net_force": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["motor.y", "viscous.force"]}}}},
    "mass":      {{"type": "Mass", "mass": {{"value": 0.2621, "unit": "{1}*s^2/{0}"}}, "in": {{"force": "net_force.sum"}}}}
  }},
  "log": ["mass.position"]
}}
)",
                                      x, f));
  }
  void write_experiment(const std::string& name) const {
    write(name + ".experiment.json", fmt::format(R"({{
  "loopwright": 1, "title": "A made-up axis", "data": "{2}.csv", "time": "t_s",
  "drive":   {{"motor.u": {{"column": "force", "unit": "{1}"}}}},
  "compare": {{"mass.position": {{"column": "position", "unit": "{0}", "resolution": 2e-7}}}},
  "roles":   {{"position": "mass.position", "velocity": "mass.velocity", "force": "net_force.sum", "input": "motor.u"}},
  "hold_out": {{"fraction": 0.25}}
}}
)",
                                                 truth_.position_unit, truth_.force_unit, name));
  }

  Truth truth_;
  std::filesystem::path folder_;
  std::vector<double> force_, position_;
};

}  // namespace loopwright
