/// Records of an axis with the flaws of real ones: any rate, stamps that jitter or are rounded, lost and
/// repeated rows, positions far from zero, coarse counts, no noise at all. The plant, its solver, controller
/// and random numbers share nothing with the blocks.
#pragma once
#include <unistd.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace loopwright {

/// Forces in newtons, lengths in metres.
struct FlawedMachine {
  double mass = 0.5, damping = 2;  ///< as the diagram has them
  double coulomb = 0, cogging = 0, pitch = 0.012, added_damping = 0, added_mass = 0;  ///< hidden
  double coulomb_from = -1e300;                  ///< position up to which there is no dry friction
  double smooth_friction = 0, smooth_speed = 1;  ///< hidden: a tanh of the speed
  double presliding = 0;            ///< of the dry friction, which then builds up over this distance
  double eddy = 0, eddy_speed = 1;  ///< hidden: a drag that falls beyond this speed
  double lag = 0;                   ///< hidden: s, of the force behind its command
  double load_mass = 0, load_hz = 30, load_damping_ratio = 0.04;  ///< hidden: a part of the mass, on a spring
  bool cogging_is_known = false;  ///< the diagram has it, and the position at the start
  double sample_time = 1e-3, duration = 20;
  double stroke = 0.2, top_speed = 0.3;
  std::vector<double> steady_speeds;  ///< instead of strokes: each one held, forward and back
  double oscillation_hz = 0;  ///< instead of strokes: a sine of this frequency and of the stroke's amplitude
  double force_noise = 0.01, sensor_noise = 5e-8, resolution = 2e-7;  ///< standard deviations, and a count
  double wander = 0, wander_s = 2;  ///< of the position sensor's offset: first-order noise, and its time
  double encoder_error = 0, encoder_pitch = 0.012;  ///< hidden: a sine of the position that is read
  double velocity_noise = 0;  ///< of a velocity sensor, which then replaces the position
  double origin = 0;          ///< position at the start
  double jitter = 0;          ///< greatest error of a sampling instant, in sample times; the stamps tell it
  double stamp_jitter = 0;    ///< greatest error of a stamp alone, in sample times
  double stamp_quantum = 0;   ///< s; stamps are rounded to it
  size_t loses_every = 0, repeats_every = 0;  ///< one row in this number
  size_t stale_every = 0;   ///< one reading in this number is that of the row before, for the controller too
  size_t holding_rows = 0;  ///< behind each, in which the command is held and nothing is read
  bool input_is_linear = false;  ///< the force between two rows; otherwise held
  double measured_late = 0;      ///< of a sample time: the position is older than its row
  double outlier = 0;            ///< added to the position of every thousandth row
  double last_bits = 0;          ///< relative error of every number
  double controller_hz = 12;     ///< where it begins to follow
  uint64_t seed = 1;
};

/// Folder with nominal.json, record.csv and record.experiment.json; removed with the object.
class FlawedAxis {
 public:
  explicit FlawedAxis(const FlawedMachine& machine, const std::string& folder = {})
      : machine_(machine), state_(0x9e3779b97f4a7c15u * (machine.seed + 1)) {
    is_kept_ = !folder.empty();
    folder_ = folder;
    if (!is_kept_) {
      const auto* test = testing::UnitTest::GetInstance()->current_test_info();
      std::string name = fmt::format("flawed_axis_{}_{}_{}", getpid(), test->test_suite_name(), test->name());
      std::ranges::replace(name, '/', '_');
      folder_ = std::filesystem::path(testing::TempDir()) / name;
    }
    std::filesystem::create_directories(folder_);
    write_diagram(), write_experiment(), write_record();
  }
  FlawedAxis(const FlawedAxis&) = delete;
  ~FlawedAxis() {
    std::error_code code;
    if (!is_kept_) std::filesystem::remove_all(folder_, code);
  }
  std::string diagram() const { return (folder_ / "nominal.json").string(); }
  std::string experiment() const { return (folder_ / "record.experiment.json").string(); }

 private:
  /// SplitMix64.
  uint64_t bits() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u, z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform() { return (double(bits() >> 11) + 0.5) / 9007199254740992.0; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

  double next_offset() {
    const double kept = std::exp(-machine_.sample_time / machine_.wander_s);
    return offset_ = kept * offset_ + machine_.wander * std::sqrt(1 - kept * kept) * normal();
  }

  struct Wanted {
    double x = 0, v = 0, a = 0;
  };
  /// From each steady speed to the next within a fifth of a second, and held for a second.
  Wanted steady(double t) const {
    constexpr double ramp = 0.2, held = 1;
    double x = 0, from = 0;
    for (size_t i = 0; i < 10000; ++i, t -= ramp + held) {
      const double speed = machine_.steady_speeds[i / 2 % machine_.steady_speeds.size()] * (i % 2 ? -1 : 1);
      const double change = speed - from, w = std::numbers::pi / ramp;
      if (t < ramp)
        return {x + from * t + change * (t - std::sin(w * t) / w) / 2,
                from + change * (1 - std::cos(w * t)) / 2, change * w * std::sin(w * t) / 2};
      x += (from + speed) / 2 * ramp;
      if (t < ramp + held) return {x + speed * (t - ramp), speed, 0};
      x += speed * held, from = speed;
    }
    return {};
  }
  /// Strokes there and back at seven peak speeds, with short rests; or a sine; or steady speeds.
  Wanted wanted(double t) const {
    constexpr double pi = std::numbers::pi, shares[] = {1, 0.25, 0.6, 0.12, 0.85, 0.4, 0.5};
    if (machine_.oscillation_hz > 0) {
      const double w = 2 * pi * machine_.oscillation_hz, a = machine_.stroke / 2;
      const double swell =
          0.6 + 0.4 * std::sin(2 * pi * t / (machine_.duration / 2.3));  // several amplitudes
      const double rise = std::min(1.0, t / 0.3) * swell;
      return {rise * a * std::sin(w * t), rise * a * w * std::cos(w * t),
              -rise * a * w * w * std::sin(w * t)};
    }
    if (!machine_.steady_speeds.empty()) return steady(t);
    double begin = 0.2, from = 0;
    for (int i = 0; i < 10000; ++i) {
      const double speed = machine_.top_speed * shares[i % 7], time = 2 * machine_.stroke / speed;
      const double sign = i % 2 ? -1 : 1, w = 2 * pi / time, s = t - begin;
      if (s < 0) return {from, 0, 0};
      if (s < time)
        return {from + sign * machine_.stroke * (s / time - std::sin(w * s) / (2 * pi)),
                sign * speed / 2 * (1 - std::cos(w * s)), sign * speed / 2 * w * std::sin(w * s)};
      begin += time + 0.1, from += sign * machine_.stroke;
    }
    return {};
  }

  /// A step of a mass with set-valued dry friction: it may stop within the step. Or friction bends first.
  void advance(double& x, double& v, double force, double h) {
    if (machine_.lag > 0) force = lagging_ += (force - lagging_) * (1 - std::exp(-h / machine_.lag));
    const double mass = machine_.mass + machine_.added_mass - machine_.load_mass;
    if (machine_.load_mass > 0) {
      const double w = 2 * std::numbers::pi * machine_.load_hz;
      const double pull = w * w * (x - load_x_) + 2 * machine_.load_damping_ratio * w * (v - load_v_);
      load_v_ += h * pull, load_x_ += h * load_v_;
      force -= machine_.load_mass * pull;
    }
    const double eddy = machine_.eddy * v / (1 + v * v / (machine_.eddy_speed * machine_.eddy_speed));
    const double free =
        force - eddy - (machine_.damping + machine_.added_damping) * v -
        machine_.cogging * std::sin(2 * std::numbers::pi * (machine_.origin + x) / machine_.pitch) -
        machine_.smooth_friction * std::tanh(v / machine_.smooth_speed);
    if (machine_.presliding > 0) {
      v += h / mass * (free - bent_), x += h * v;
      bent_ += std::abs(h * v) / machine_.presliding * (std::copysign(machine_.coulomb, v) - bent_);
      return;
    }
    const double fast = v + h / mass * free,
                 most = x < machine_.coulomb_from ? 0 : machine_.coulomb * h / mass;
    const double next = std::copysign(std::max(std::abs(fast) - most, 0.0), fast);
    x += h * (v + next) / 2, v = next;
  }

  void write_record() {
    constexpr double finest = 2e-5, steps_a_decay = 500;
    const double T = machine_.sample_time;
    const size_t rows = size_t(machine_.duration / T);
    const double cutoff = 2 * std::numbers::pi * std::min(machine_.controller_hz, 0.04 / T),
                 gain = cutoff * cutoff;
    double x = 0, v = 0, slow = 0, seen_speed = 0, last_seen = 0, last_time = 0, command = 0;
    std::ofstream out(folder_ / "record.csv");
    out << "t_s,force,position,velocity\n";
    std::string line;
    for (size_t k = 0; k < rows; ++k) {
      const auto instant = [&](size_t i) { return double(i) * T; };
      const double off = k == 0 ? 0 : ahead_, now = instant(k) + off;
      ahead_ = machine_.jitter * T * (2 * uniform() - 1);
      const double next = instant(k + 1) + ahead_, step = next - now;
      const double behind = machine_.measured_late * T;
      double place = machine_.origin + (x - behind * v) + machine_.sensor_noise * normal();
      if (machine_.wander > 0) place += next_offset();
      place += machine_.encoder_error * std::sin(2 * std::numbers::pi * place / machine_.encoder_pitch);
      if (machine_.resolution > 0) place = std::round(place / machine_.resolution) * machine_.resolution;
      if (machine_.stale_every > 0 && k % machine_.stale_every == 5) place = last_place_;
      last_place_ = place;
      const double seen = place - machine_.origin, speed = v + machine_.velocity_noise * normal();
      if (k == 0) last_seen = seen, last_time = now - T;
      const double difference = machine_.velocity_noise > 0 ? speed : (seen - last_seen) / (now - last_time);
      seen_speed += (1 - std::exp(-8 * cutoff * (now - last_time))) * (difference - seen_speed);
      last_seen = seen, last_time = now;
      const Wanted to = wanted(now);
      const double before = command;
      command = machine_.mass * (to.a + 1.4 * cutoff * (to.v - seen_speed) +
                                 (machine_.velocity_noise > 0 ? 0 : gain * (to.x - seen))) +
                machine_.damping * to.v;
      const double begin = machine_.input_is_linear ? before : command, rise = command - begin;
      double stamp = now + machine_.stamp_jitter * T * (2 * uniform() - 1);
      if (machine_.stamp_quantum > 0)
        stamp = std::round(stamp / machine_.stamp_quantum) * machine_.stamp_quantum;
      if (machine_.outlier != 0 && k % 1000 == 500) place += machine_.outlier;
      const auto told = [&](double number) {
        return number * (1 + machine_.last_bits * (2 * uniform() - 1));
      };
      const bool is_lost = machine_.loses_every > 0 && k % machine_.loses_every == machine_.loses_every / 2;
      const bool repeats = machine_.repeats_every > 0 && k % machine_.repeats_every == 7;
      line = fmt::format("{:.9f},{:.15g},{:.15g},{:.15g}\n", std::max(stamp, 0.0), told(begin), told(place),
                         told(speed));
      if (!is_lost) out << line;
      for (size_t i = 1; i <= machine_.holding_rows; ++i)
        out << fmt::format("{:.9f},{:.15g},,\n", stamp + double(i) * T / double(machine_.holding_rows + 1),
                           command);
      if (repeats) out << line;
      const double push = machine_.force_noise * normal();
      const double decays = machine_.damping / machine_.mass * step;
      const int substeps = std::max({20, int(std::ceil(step / finest)), int(steps_a_decay * decays)});
      for (int i = 0; i < substeps; ++i)
        advance(x, v, begin + rise * (i + 0.5) / substeps + push + slow, step / substeps);
      const double memory = std::exp(-T / 0.03);
      slow = memory * slow + 0.3 * machine_.force_noise * std::sqrt(1 - memory * memory) * normal();
    }
  }
  void write_diagram() const {
    std::string cogging, start;
    if (machine_.cogging_is_known) {
      cogging = fmt::format(
          R"(
    "cogging":   {{"type": "CoggingForce", "pole_pitch": {{"value": {}, "unit": "m"}}, "harmonics": [{{"order": 1, "amplitude": {{"value": {}, "unit": "N"}}}}], "in": {{"position": "mass.position"}}}},)",
          machine_.pitch, machine_.cogging);
      start = fmt::format(R"("initial_position": {{"value": {}, "unit": "m"}}, )", machine_.origin);
    }
    std::ofstream(folder_ / "nominal.json")
        << fmt::format(R"({{
  "loopwright": 1, "title": "An axis, nominal",
  "solver": {{"method": "rk4", "step": 0.001, "stop": 12}},
  "blocks": {{
    "force":     {{"type": "Constant", "value": {{"value": 0, "unit": "N"}}}},
    "motor":     {{"type": "Gain", "gain": 1, "in": {{"u": "force.y"}}}},
    "viscous":   {{"type": "ViscousFriction", "damping": {{"value": {}, "unit": "N*s/m"}}, "in": {{"velocity": "mass.velocity"}}}},
    {}"net_force": {{"type": "Sum", "signs": "+-{}", "in": {{"terms": ["motor.y", "viscous.force"{}]}}}},
    "mass":      {{"type": "Mass", "mass": {{"value": {}, "unit": "kg"}}, {}"in": {{"force": "net_force.sum"}}}}
  }},
  "log": ["mass.position"]
}}
)",
                       machine_.damping, cogging, cogging.empty() ? "" : "-",
                       cogging.empty() ? "" : R"(, "cogging.force")", machine_.mass, start);
  }
  void write_experiment() const {
    const std::string compared =
        machine_.velocity_noise > 0
            ? std::string(R"("mass.velocity": {"column": "velocity", "unit": "m/s"})")
            : fmt::format(R"("mass.position": {{"column": "position", "unit": "m", "resolution": {}}})",
                          machine_.resolution);
    std::ofstream(folder_ / "record.experiment.json") << fmt::format(
        R"({{
  "loopwright": 1, "title": "A flawed record", "data": "record.csv", "time": "t_s",
  "drive":   {{"motor.u": {{"column": "force", "unit": "N"{}}}}},
  "compare": {{{}}},
  "roles":   {{"position": "mass.position", "velocity": "mass.velocity", "force": "net_force.sum", "input": "motor.u"}},
  "hold_out": {{"fraction": 0.25}}
}}
)",
        machine_.input_is_linear ? R"(, "interpolation": "linear")" : "", compared);
  }

  FlawedMachine machine_;
  uint64_t state_;
  std::filesystem::path folder_;
  bool is_kept_ = false;
  double last_place_ = 0, lagging_ = 0, offset_ = 0;
  double ahead_ = 0;  // of the next sampling instant
  double bent_ = 0;   // force of friction that builds up over a distance
  double load_x_ = 0, load_v_ = 0;
};

}  // namespace loopwright
