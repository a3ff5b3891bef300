/// Noise of an amplifier on a record of a low rate: it is forgotten within a few samples. The record is made
/// by an integration of its own.
#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plain_axis.h"
#include "tools/diagnose/search/noise_likelihood.h"
#include "tools/diagnose/search/prepare.h"

namespace loopwright::slow_noise_test {
namespace {

/// 0.5 kg with 7 N s/m at 200 Hz. A slow force of 18 ms is larger than the white one, which is small at this
/// rate; its density at zero frequency is nine times that of the white one.
struct NoisyMachine {
  double sample_time = 5e-3, white = 0.03, slow = 0.033, time = 0.018, sensor_noise = 0, count = 1.5e-7;
  int rows = 2000;
};

std::string record(const NoisyMachine& machine) {
  constexpr double mass = 0.5, damping = 7;
  constexpr int substeps = 100;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 1);
  const double memory = std::exp(-machine.sample_time / machine.time);
  std::string text = "t,u [N],x [m]\n";
  double x = 0, v = 0, drift = 0;
  for (int k = 0; k < machine.rows; ++k) {
    const double t = k * machine.sample_time;
    const double u = 2 * std::sin(2.1 * t) + 1.5 * std::sin(7.3 * t) + std::sin(19 * t);
    const double read = x + machine.sensor_noise * normal(random);
    text += fmt::format("{:.8g},{:.12g},{:.12g}\n", t, u, machine.count * std::round(read / machine.count));
    drift = memory * drift + machine.slow * std::sqrt(1 - memory * memory) * normal(random);
    const double disturbance = machine.white * normal(random) + drift;
    for (int i = 0; i < substeps; ++i) {  // semi-implicit Euler
      const double h = machine.sample_time / substeps;
      v += h * (u - damping * v + disturbance) / mass, x += h * v;
    }
  }
  return text;
}

void write(const NoisyMachine& machine, DiagramFolder& folder) {
  write_plain_axis(folder, {.csv = record(machine), .count = machine.count});
}

TEST(SlowNoise, ThatIsForgottenWithinAFewSamplesIsNoise) {
  DiagramFolder folder;
  write({}, folder);
  const Diagnosis found = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
  EXPECT_EQ(found.verdict, Verdict::nothing_missing) << to_text(found);
  EXPECT_NEAR(found.slow_force, 0.033, 0.007);
}

/// Whether what the nominal diagram leaves of a record counts as noise, and how large a slow force is found.
struct Remainder {
  bool is_noise;
  double slow_force;
};

Remainder remainder_of(const NoisyMachine& machine) {
  using namespace diagnosis;
  DiagramFolder folder;
  write(machine, folder);
  Motion motion;
  Trials trials = prepare(folder.path("axis.json"), {folder.path("e.json")}, {}, motion);
  trials.run_along(Trials::Rows::fitted);
  motion = cut(motion, trials);
  const Estimate estimate = fit_members(trials, {}, search_noise(trials), motion, 0);
  return {is_remainder_noise(trials, *estimate.fitted, estimate.noise),
          fit_noise_alone(trials, *estimate.fitted, estimate.noise, FreeNoise::all).slow()};
}

/// A sensor's noise hides how much white noise a slow force has beside it: the likelihood is flat then, and
/// its maximum may be where there is none. What that slow force is cannot be told from noise.
TEST(SlowNoise, BesideWhiteNoiseThatASensorHidesIsNoise) {
  const NoisyMachine hidden{
      .sample_time = 1e-3, .white = 0.02, .slow = 0.03, .time = 0.3, .sensor_noise = 1e-5, .rows = 10000};
  const Remainder remainder = remainder_of(hidden);
  EXPECT_TRUE(remainder.is_noise);
  EXPECT_NEAR(remainder.slow_force, 0.03, 0.01);
}
/// With a sensor that shows it, the same force is something that the model lacks.
TEST(SlowNoise, FarAboveWhiteNoiseThatIsSeenIsNone) {
  const NoisyMachine seen{
      .sample_time = 1e-3, .white = 0.001, .slow = 0.03, .time = 0.3, .sensor_noise = 0, .rows = 10000};
  EXPECT_FALSE(remainder_of(seen).is_noise);
}

/// What is no noise counts as white noise, of which coarse counts ask for more than it has in a row: they
/// show only the slow part of the motion. As loud as the errors ask for, it predicts better than any other.
TEST(SlowNoise, CountsAsWhiteAsLoudAsTheErrorsAskFor) {
  using namespace diagnosis;
  DiagramFolder folder;
  write({.sample_time = 1e-3, .white = 0.02, .slow = 0.5, .time = 0.3, .count = 2e-5, .rows = 10000}, folder);
  Motion motion;
  Trials trials = prepare(folder.path("axis.json"), {folder.path("e.json")}, {}, motion);
  trials.run_along(Trials::Rows::fitted);
  motion = cut(motion, trials);
  const Estimate estimate = fit_members(trials, {}, search_noise(trials), motion, 0);
  ASSERT_FALSE(is_remainder_noise(trials, *estimate.fitted, estimate.noise));
  const Noise noise = fit_noise_alone(trials, *estimate.fitted, estimate.noise, FreeNoise::all);
  EXPECT_LT(noise.slow(), 0.1 * noise.white);
  std::vector<double> error;
  const auto misfit = [&](double factor) {
    Noise other = noise;
    other.white *= factor, other.step *= factor;
    return noise_misfit(trials, *estimate.fitted, other, error);
  };
  EXPECT_LT(misfit(1), misfit(0.8));
  EXPECT_LT(misfit(1), misfit(1.25));
}

/// Rows of 20 kHz have each much white noise, beside which any slow force is small: that of a millisecond
/// decides. A force that rises and falls within 0.6 s, and exceeds it, is something that the model lacks;
/// that of an amplifier is noise at this rate too.
TEST(SlowNoise, IsComparedWithTheWhiteNoiseOfAMillisecondAtAnyRate) {
  NoisyMachine fast{
      .sample_time = 5e-5, .white = 0.4, .slow = 0.2, .time = 0.6, .count = 1e-10, .rows = 60000};
  EXPECT_FALSE(remainder_of(fast).is_noise);
  fast.slow = 0.12, fast.time = 0.03;  // more than a fifth of the white noise, which is that of a millisecond
  EXPECT_TRUE(remainder_of(fast).is_noise);
}

}  // namespace
}  // namespace loopwright::slow_noise_test
