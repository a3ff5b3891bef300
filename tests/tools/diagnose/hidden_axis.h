/// Records of an axis from the generator's plant (tests/hidden_effects, plain C): its physics, solver and
/// random numbers share nothing with the blocks. Any motion, controller or none, any units.
#pragma once
#include <unistd.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>
extern "C" {
#include "tests/hidden_effects/controller.h"
#include "tests/hidden_effects/plant.h"
#include "tests/hidden_effects/random.h"
}

namespace loopwright {

constexpr double hidden_sample_time = 1e-3;

/// Reference positions, one for each sample: strokes whose speed rises and falls by half a cosine.
struct WantedMotion {
  std::vector<double> position{0};
  std::vector<double> added_force;  ///< added to the command; empty: none
  double initial_speed = 0;         ///< the axis already moves

  WantedMotion& rest(double seconds) {
    position.insert(position.end(), size_t(seconds / hidden_sample_time), position.back());
    return *this;
  }
  WantedMotion& stroke(double way, double speed, double ramp_s) {
    const double begin = position.back(), size = std::abs(way), end = size / speed + ramp_s;
    const auto risen = [&](double t) {
      if (t >= ramp_s) return speed * (t - ramp_s / 2);
      return speed / 2 * (t - ramp_s / std::numbers::pi * std::sin(std::numbers::pi * t / ramp_s));
    };
    for (double t = hidden_sample_time; t < end; t += hidden_sample_time)
      position.push_back(begin + std::copysign(t < end - ramp_s ? risen(t) : size - risen(end - t), way));
    position.push_back(begin + way);
    return *this;
  }
};

/// Forward and back at three speeds.
inline WantedMotion there_and_back(double way, double top_speed) {
  WantedMotion motion;
  motion.rest(0.2);
  for (double share : {1.0, 0.25, 0.6})
    for (double sign : {1.0, -1.0}) motion.stroke(sign * way, share * top_speed, 0.1).rest(0.1);
  return motion;
}

/// Several speeds in one direction (1 or -1), with a rest after each.
inline WantedMotion one_way(double direction) {
  WantedMotion motion;
  motion.rest(0.2);
  for (double speed : {0.2, 0.4, 0.1, 0.3}) motion.stroke(direction * 0.15, speed, 0.1).rest(0.2);
  return motion;
}

/// The same speeds from the first sample to the last: friction never holds the axis.
inline WantedMotion one_way_without_rest(double direction) {
  WantedMotion motion;
  constexpr double ramp_s = 0.1, cruise_s = 0.5, end_s = 3 * (ramp_s + cruise_s) + cruise_s;
  const double speeds[] = {0.2, 0.4, 0.1, 0.3, 0.3};
  motion.initial_speed = direction * speeds[0];
  for (double t = 0; t < end_s; t += hidden_sample_time) {
    const size_t i = size_t(t / (ramp_s + cruise_s));
    const double into_ramp = std::clamp((t - double(i) * (ramp_s + cruise_s) - cruise_s) / ramp_s, 0.0, 1.0);
    const double risen = 0.5 - 0.5 * std::cos(std::numbers::pi * into_ramp);
    const double speed = direction * (speeds[i] + risen * (speeds[i + 1] - speeds[i]));
    motion.position.push_back(motion.position.back() + speed * hidden_sample_time);
  }
  return motion;
}

/// The diagram's model of the axis, and the noise of its measurement.
struct HiddenMachine {
  double mass = 0.2621, damping = 3;
  std::string position_unit = "m", force_unit = "N";
  /// Of the recorded input: of its column, of the diagram, and the motor's gain; empty: it is the force.
  std::string column_unit, input_unit, gain = "1";
  double newtons_per_column = 1;
  double force_noise = 0.01, encoder_noise = 5e-8, resolution = 2e-7;
  std::optional<double> velocity_noise;  ///< measured with this noise; empty: not measured
  bool measures_position = true, has_controller = true;
  double leaves_out_s = 0;  ///< of the start of every record
  double clock_s = 0;       ///< what the clock of the records shows when the motion begins
  double unfelt_noise = 0;  ///< of the recorded input, that the machine does not feel
  /// What arrives of a command at a time; empty: all of it.
  std::function<double(double command, double time)> drive;
  std::function<double(double position)> sensor;  ///< what it shows; empty: the position
  /// Of the rows, which have a reading; the cells of all others are empty.
  size_t reads_position_every = 1, reads_velocity_every = 1;
  size_t loses_every = 0;  ///< one row in this number that a device would have lost; 0: none
  std::string position_port = "mass.position", velocity_port = "mass.velocity",
              damping_port = "viscous.force";
  std::string further_blocks;   ///< of the diagram
  std::string moving, viscous;  ///< replace its Mass and its ViscousFriction; empty: these
};

/// Folder with nominal.json and a pair of files for every record; removed with the object.
class HiddenAxis {
 public:
  explicit HiddenAxis(HiddenMachine machine = {}) : machine_(std::move(machine)) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              fmt::format("hidden_axis_{}_{}_{}", getpid(), test->test_suite_name(), test->name());
    std::filesystem::create_directories(folder_);
    if (machine_.input_unit.empty()) machine_.input_unit = machine_.force_unit;
    if (machine_.column_unit.empty()) machine_.column_unit = machine_.input_unit;
    write_diagram();
  }
  HiddenAxis(const HiddenAxis&) = delete;
  ~HiddenAxis() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  /// The physics of the diagram. A truth is this plus the hidden effects.
  Physics nominal() const {
    Physics physics{};
    physics.mass_kg = machine_.mass, physics.damping_n_s_per_m = machine_.damping;
    return physics;
  }
  std::string diagram() const { return file("nominal.json"); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Records the motion and returns the path of the experiment.
  std::string record(const std::string& name, const Physics& truth, const WantedMotion& wanted) {
    write_data(name, truth, wanted), write_experiment(name);
    return file(name + ".experiment.json");
  }
  /// Rms of the command in the last record.
  double force_level() const { return force_level_; }

 private:
  void write_data(const std::string& name, const Physics& truth, const WantedMotion& wanted) {
    Random random = random_stream(1, name.c_str());
    ::Plant plant = plant_at_rest(&truth, hidden_sample_time, 10);
    Controller controller =
        controller_make(PD_WITH_OBSERVER, machine_.mass, machine_.damping, hidden_sample_time);
    const std::vector<double>& x = wanted.position;
    const double home = x.front();
    plant.state[POSITION] = plant.state[LOAD_POSITION] = home, plant.state[VELOCITY] = wanted.initial_speed;
    double slow = 0, square = 0;
    std::ofstream out(file(name + ".csv"));
    out << "t_s,force,position,velocity\n";
    const double scale = machine_.force_noise, memory = std::exp(-hidden_sample_time / 0.03);
    for (size_t k = 0; k < x.size(); ++k) {
      const double before = x[k > 0 ? k - 1 : 0], after = x[std::min(k + 1, x.size() - 1)];
      const double speed = k > 0 ? (after - before) / (2 * hidden_sample_time) : wanted.initial_speed;
      const double acceleration =
          k > 0 ? (after - 2 * x[k] + before) / (hidden_sample_time * hidden_sample_time) : 0;
      const double feedforward = machine_.mass * acceleration + machine_.damping * speed;
      const double shown = machine_.sensor ? machine_.sensor(plant_encoder(&plant)) : plant_encoder(&plant);
      const double seen =
          std::round((shown + machine_.encoder_noise * random_normal(&random)) / machine_.resolution) *
          machine_.resolution;
      double force = feedforward;
      if (machine_.has_controller)
        force = controller_step(&controller, x[k] - home, feedforward, seen - home);
      if (!wanted.added_force.empty()) force += wanted.added_force[k];
      const double velocity =
          plant.state[VELOCITY] + machine_.velocity_noise.value_or(0) * random_normal(&random);
      const double t = double(k) * hidden_sample_time;
      const bool is_lost = machine_.loses_every > 0 && k % machine_.loses_every == machine_.loses_every / 2;
      const double felt = machine_.drive ? machine_.drive(force, t) : force;
      if (machine_.unfelt_noise > 0) force += machine_.unfelt_noise * random_normal(&random);
      if (t >= machine_.leaves_out_s && !is_lost)
        out << fmt::format("{:.3f},{:.10g},{},{}\n", machine_.clock_s + t,
                           force / machine_.newtons_per_column,
                           k % machine_.reads_position_every == 0 ? fmt::format("{:.10g}", seen) : "",
                           k % machine_.reads_velocity_every == 0 ? fmt::format("{:.10g}", velocity) : "");
      plant_sample(&plant, felt, scale * random_normal(&random) + slow);
      slow = memory * slow + 0.3 * scale * std::sqrt(1 - memory * memory) * random_normal(&random);
      square += force * force;
    }
    force_level_ = std::sqrt(square / double(x.size()));
  }
  void write_diagram() const {
    std::string moving = machine_.moving, viscous = machine_.viscous;
    if (moving.empty())
      moving = fmt::format(
          R"("mass":      {{"type": "Mass", "mass": {{"value": {}, "unit": "{}*s^2/{}"}}, "in": {{"force": "net_force.sum"}}}})",
          machine_.mass, machine_.force_unit, machine_.position_unit);
    if (viscous.empty())
      viscous = fmt::format(
          R"("viscous":   {{"type": "ViscousFriction", "damping": {{"value": {}, "unit": "{}*s/{}"}}, "in": {{"velocity": "{}"}}}})",
          machine_.damping, machine_.force_unit, machine_.position_unit, machine_.velocity_port);
    std::ofstream(file("nominal.json")) << fmt::format(
        R"({{
  "loopwright": 1,
  "title": "An axis, nominal",
  "solver": {{"method": "rk4", "step": 0.001, "stop": 12}},
  "blocks": {{
    "force":     {{"type": "Constant", "value": {{"value": 0, "unit": "{7}"}}}},
    "motor":     {{"type": "Gain", "gain": {8}, "in": {{"u": "force.y"}}}},
    {3},
    "net_force": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["motor.y", "{6}"]}}}},
    {4}
    {2}
  }},
  "log": ["{5}"]
}}
)",
        machine_.position_unit, machine_.force_unit, moving, viscous, machine_.further_blocks,
        machine_.position_port, machine_.damping_port, machine_.input_unit, machine_.gain);
  }
  void write_experiment(const std::string& name) const {
    std::string compared;
    if (machine_.measures_position)
      compared = fmt::format(R"("{}": {{"column": "position", "unit": "{}", "resolution": {}}})",
                             machine_.position_port, machine_.position_unit, machine_.resolution);
    if (machine_.velocity_noise)
      compared += fmt::format(R"({}"{}": {{"column": "velocity", "unit": "{}/s"}})",
                              compared.empty() ? "" : ", ", machine_.velocity_port, machine_.position_unit);
    std::ofstream(file(name + ".experiment.json")) << fmt::format(
        R"({{
  "loopwright": 1, "title": "{0}", "data": "{0}.csv", "time": "t_s",
  "drive":   {{"motor.u": {{"column": "force", "unit": "{1}"}}}},
  "compare": {{{2}}},
  "roles":   {{"position": "{3}", "velocity": "{4}", "force": "net_force.sum", "input": "motor.u"}}
}}
)",
        name, machine_.column_unit, compared, machine_.position_port, machine_.velocity_port);
  }

  HiddenMachine machine_;
  std::filesystem::path folder_;
  double force_level_ = 0;
};

}  // namespace loopwright
