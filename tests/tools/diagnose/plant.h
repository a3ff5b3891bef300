/// Records of simulated plants beside a diagram of them that may lack something. The simulation has its own
/// equations and integration, and shares nothing with the blocks.
#pragma once
#include <unistd.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>
#include "models/signal/between_rows.h"

namespace loopwright {

using Numbers = std::vector<double>;

struct Plant {
  std::string diagram;         ///< JSON
  std::string drive, compare;  ///< members of the experiment; columns u, y0, y1 …
  std::string more;            ///< further members: R"("sites": …)"
  std::function<Numbers(const Numbers& x, double u, const Numbers& w)> rate;  ///< w: process noise
  std::function<Numbers(const Numbers& x)> outputs;
  std::function<double(double time)> input;
  double delay = 0;                              ///< s; the input acts so much later than it is recorded
  BetweenRows between_rows = BetweenRows::hold;  ///< what the input does; band-limited: as `input` is there
  Numbers initial, process_noise, measurement_noise;
  Numbers slow_noise;  ///< beside the process noise, alike for slow_samples; or empty
  double slow_samples = 60;
  double sample_time = 0.01;
  double jitter = 0;  ///< [samples] of the time stamps, at which everything truly happens
  size_t rows = 2500;
  std::vector<size_t> reads_every;  ///< [rows] of each output; empty: it is read in every row
  uint64_t seed = 1;
};

/// Files of a plant in a folder of their own, removed with the object.
class RecordedPlant {
 public:
  explicit RecordedPlant(const Plant& plant) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              fmt::format("plant_{}_{}_{}_{}", getpid(), test->test_suite_name(), test->name(), plant.seed);
    std::filesystem::create_directories(folder_);
    write("nominal.json", plant.diagram);
    write("experiment.json",
          fmt::format(R"({{"loopwright": 1, "data": "record.csv", "time": "t_s",
  "drive": {{{}}}, "compare": {{{}}}, "hold_out": {{"fraction": 0.25}}{}{}}})",
                      plant.drive, plant.compare, plant.more.empty() ? "" : ", ", plant.more));
    write("record.csv", record(plant));
  }
  ~RecordedPlant() {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  std::string diagram() const { return (folder_ / "nominal.json").string(); }
  std::string experiment() const { return (folder_ / "experiment.json").string(); }

 private:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  static std::string record(const Plant& plant) {
    constexpr int substeps = 40;
    std::mt19937_64 random(plant.seed);
    std::normal_distribution<double> normal;
    Numbers x = plant.initial;
    const auto moved = [](Numbers from, const Numbers& slope, double by) {
      for (size_t i = 0; i < from.size(); ++i) from[i] += by * slope[i];
      return from;
    };
    std::string text = "t_s,u";
    for (size_t j = 0; j < plant.measurement_noise.size(); ++j) text += fmt::format(",y{}", j);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    const double kept = std::exp(-1 / plant.slow_samples);
    Numbers slow;
    for (double size : plant.slow_noise) slow.push_back(size * normal(random));
    double t = 0;
    for (size_t k = 0; k < plant.rows; ++k) {
      const double u = plant.input(t);
      text += fmt::format("\n{:.12g},{:.12g}", t, u);
      const Numbers y = plant.outputs(x);
      for (size_t j = 0; j < y.size(); ++j) {
        const double read = y[j] + plant.measurement_noise[j] * normal(random);
        const bool is_read = plant.reads_every.empty() || k % plant.reads_every[j] == 0;
        text += is_read ? fmt::format(",{:.12g}", read) : ",";
      }
      Numbers w;
      for (double size : plant.process_noise) w.push_back(size * normal(random));
      for (size_t i = 0; i < slow.size(); ++i) {
        w[i] += slow[i];
        slow[i] = kept * slow[i] + std::sqrt(1 - kept * kept) * plant.slow_noise[i] * normal(random);
      }
      const double next = (double(k + 1) + plant.jitter * uniform(random)) * plant.sample_time;
      const double h = (next - t) / substeps;
      const auto acting = [&](double part) {  // of the sample
        if (plant.delay > 0) return late_input(plant, t + part * (next - t));
        if (plant.between_rows == BetweenRows::hold) return u;
        if (plant.between_rows == BetweenRows::band_limited) return plant.input(t + part * (next - t));
        return u + part * (plant.input(next) - u);
      };
      for (int i = 0; i < substeps; ++i) {
        const double begin = acting(double(i) / substeps), middle = acting((i + 0.5) / substeps),
                     end = acting(double(i + 1) / substeps);
        const Numbers a = plant.rate(x, begin, w), b = plant.rate(moved(x, a, h / 2), middle, w),
                      c = plant.rate(moved(x, b, h / 2), middle, w), d = plant.rate(moved(x, c, h), end, w);
        for (size_t s = 0; s < x.size(); ++s) x[s] += h / 6 * (a[s] + 2 * b[s] + 2 * c[s] + d[s]);
      }
      t = next;
    }
    return text + "\n";
  }

  /// Held, or on lines. Before the record it is as at its start.
  static double late_input(const Plant& plant, double time) {
    const double row = std::max(0.0, (time - plant.delay) / plant.sample_time), before = std::floor(row);
    const double u = plant.input(before * plant.sample_time);
    if (plant.between_rows == BetweenRows::hold) return u;
    return u + (row - before) * (plant.input((before + 1) * plant.sample_time) - u);
  }

  std::filesystem::path folder_;
};

/// Steps of random height, each held for `hold` seconds, from -1 to 1.
inline std::function<double(double)> random_steps(double hold, uint64_t seed) {
  return [hold, seed](double t) {
    std::mt19937_64 random(seed * 7919 + uint64_t(t / hold + 1e-9));
    random.discard(3);
    return std::uniform_real_distribution<double>(-1, 1)(random);
  };
}

inline double sign(double x) { return std::tanh(x / 1e-3); }

}  // namespace loopwright
