// A load on a spring that swings faster than the balance of forces shows. The record is made by an
// integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>
#include <random>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plain_axis.h"

namespace loopwright::fast_load_test {
namespace {

constexpr double mass = 0.5, damping = 7, load = 0.05, hz = 200, damping_ratio = 0.03,
                 turn = 2 * std::numbers::pi;

constexpr double sample_time = 5e-5, count = 1e-9;

/// 0.6 s at 20 kHz of forces of 4 to 230 Hz, open loop.
std::string record(unsigned seed) {
  constexpr double sensor_noise = 3e-8, force_noise = 0.1;
  constexpr int rows = 12000, substeps = 10;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const double w = turn * hz, phase = double(seed);
  std::string text = "t,u [N],x [m]\n";
  double x = 0, v = 0, load_x = 0, load_v = 0;
  for (int k = 0; k < rows; ++k) {
    const double t = k * sample_time;
    const double u = 2 * std::sin(turn * 4 * t) + std::sin(turn * 13 * t + phase) +
                     0.6 * std::sin(turn * 171 * t + 2 * phase) + 0.6 * std::sin(turn * 230 * t + 3 * phase);
    const double read = x + sensor_noise * normal(random);
    text += fmt::format("{:.8g},{:.12g},{:.12g}\n", t, u, count * std::round(read / count));
    const double force = u + force_noise * normal(random);
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = sample_time / substeps;
      const double pull = w * w * (x - load_x) + 2 * damping_ratio * w * (v - load_v);
      v += h * (force - damping * v - load * pull) / (mass - load), x += h * v;
      load_v += h * pull, load_x += h * load_v;
    }
  }
  return text;
}

Diagnosis diagnosed(unsigned seed) {
  DiagramFolder folder;
  write_plain_axis(folder,
                   {.csv = record(seed), .count = count, .solver_step = sample_time, .held_out = 0.25});
  return diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
}

/// Less than a hundredth of its force is below the 80 Hz of the balance, where chance gives it a sign.
TEST(FastLoad, IsNamedThoughTheBalanceOfForcesDoesNotShowIt) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const Diagnosis d = diagnosed(seed);
    ASSERT_THAT(names(d), testing::ElementsAre("flexible_mode")) << seed << to_text(d);
    EXPECT_EQ(name_of(d.verdict), "explained") << seed << to_text(d);
    expect_parameter(d.effects[0], "load_mass", load, 0.003, "N*s^2/m");
    expect_parameter(d.effects[0], "frequency", hz, 1.5, "Hz");
  }
}

}  // namespace
}  // namespace loopwright::fast_load_test
