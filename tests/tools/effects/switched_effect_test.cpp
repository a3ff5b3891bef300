// A load that is driven through a gap, one sample at a time.
#include "tools/effects/switched_effect.h"
#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::switched_effect_test {
namespace {

constexpr double sample_time = 1e-3, load = 0.12, gap = 3e-4, frequency = 60, ratio = 0.2;
const double stiffness = load * std::pow(2 * M_PI * frequency, 2),
             flank_damping = 2 * ratio * load * 2 * M_PI * frequency,
             drag = axis_sizes().machine_damping * load / axis_sizes().machine_mass,
             body = axis_sizes().machine_mass - load;

std::shared_ptr<const EffectPlan> compiled(const std::string& name) {
  RecordSizes sizes = axis_sizes();
  sizes.sample_time = sample_time;
  Problems problems;
  auto plan = compile_effect(effect_named(name), {}, sizes, problems);
  EXPECT_EQ(problems.text(), "");
  return plan;
}

struct Backlash : SwitchedSample {
  Backlash() : SwitchedSample(compiled("backlash"), {load, gap, frequency, ratio}) {
    set_body({body, -load});
  }
};

double force_of_flank(double way, double rate) {
  if (way > gap / 2) return std::max(0.0, stiffness * (way - gap / 2) + flank_damping * rate);
  if (way < -gap / 2) return std::min(0.0, stiffness * (way + gap / 2) + flank_damping * rate);
  return 0;
}

/// What happens in a sample to a body that would move freely with this acceleration.
struct Happens {
  double load_position, load_velocity, mean, slope;
};
/// Semi-implicit Euler in steps of 10 ns. The drag that the load takes along is missed at the body.
Happens integrated(double x, double v, double free, double load_x, double load_v) {
  constexpr int steps = 100000;
  constexpr double h = sample_time / steps;
  double impulse = 0, moment = 0;
  for (int i = 0; i < steps; ++i) {
    const double d = x - load_x, rate = v - load_v;
    const double contact = force_of_flank(d, rate), push = contact - drag * v;
    impulse += push * h, moment += push * h * ((i + 0.5) / steps - 0.5);
    v += h * (free - push / body), load_v += h * (contact - drag * load_v) / load;
    x += h * v, load_x += h * load_v;
  }
  return {load_x, load_v, impulse / sample_time, 12 * moment / sample_time};
}

/// `decided_at`: approach at which a flank is met within the sample; a part of it passes unnoticed.
void expect_as_integrated(SwitchedSample& sample, double x, double v, double free, double load_x,
                          double load_v, double decided_at = 0, double unnoticed = 1.0 / 16) {
  const Happens expected = integrated(x, v, free, load_x, load_v);
  const std::vector<double> states{load_x, load_v};
  const std::vector<double> result = sample.from(states, {{x, v, free, free, 0, 0, 0}});
  const double missed = flank_damping * decided_at * unnoticed;
  const double size = 0.01 * (std::abs(expected.mean) + drag * std::abs(v)) + missed;
  EXPECT_NEAR(result[0], expected.load_position, size * sample_time * sample_time / load + 1e-9);
  EXPECT_NEAR(result[1], expected.load_velocity, size * sample_time / load);
  EXPECT_NEAR(result[2], expected.mean, size);
  EXPECT_NEAR(result[3], expected.slope, 6 * size);
}

TEST(SwitchedEffect, OfTheCatalogueOnlyTheBacklashIsOne) {
  for (const Effect& effect : whole_catalogue()) {
    RecordSizes sizes = axis_sizes();
    sizes.sample_time = sample_time;
    Problems problems;
    const auto plan = compile_effect(effect, {}, sizes, problems);
    ASSERT_TRUE(plan) << effect.name;
    EXPECT_EQ(plan->is_switched, effect.name == "backlash") << effect.name;
  }
}

TEST(SwitchedEffect, FliesTouchesAndLeavesAsTwoBodiesDo) {
  Backlash sample;
  for (int round = 0; round < 2; ++round) {  // at first integrated, then by the map of the mode
    expect_as_integrated(sample, 0.3, 0.2, 0.7, 0.3 + 0.2e-4, 0.18);
    expect_as_integrated(sample, 0.3 + gap / 2 + 3e-5, 0.2, -4, 0.3, 0.18);
    expect_as_integrated(sample, 0.1 - gap / 2 - 3e-5, -0.2, 4, 0.1, -0.18);
  }
  expect_as_integrated(sample, 0.3 + gap / 2 - 1e-5, 0.2, 0, 0.3, 0.18, 0.02);    // touches within it
  expect_as_integrated(sample, 0.3 + gap / 2 + 4e-6, 0.2, -20, 0.3, 0.2 + 4e-3);  // leaves within it
}

/// Relative deviations of the mean forces along a measured motion that rattles.
double deviation_along_a_motion(const std::shared_ptr<const EffectPlan>& plan, int sets) {
  constexpr size_t rows = 3000;
  constexpr double amplitude = 0.02, turning = 2 * M_PI * 2;  // rad/s
  std::vector<double> x, v, a, force(rows);
  for (size_t k = 0; k < rows; ++k) {
    const double phase = turning * double(k) * sample_time;
    x.push_back(amplitude * std::sin(phase)), v.push_back(turning * amplitude * std::cos(phase));
    a.push_back(-turning * turning * x.back());
  }
  EffectRun run(plan, sets);
  for (int lane = 0; lane < run.lanes(); ++lane)
    for (size_t i = 0; i < 4; ++i) run.set(i, std::array{load, gap, frequency, ratio}[i], lane);
  RoleSignals signals;
  signals.position = x, signals.velocity = v, signals.acceleration = a;
  run.run(signals, force);
  double load_x = x[0], load_v = v[0], square = 0, apart = 0;
  for (size_t k = 0; k < rows; ++k) {
    constexpr int steps = 1000;
    constexpr double h = sample_time / steps;
    double mean = -load * a[k];
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * h, rate = v[k] + a[k] * t - load_v;
      const double d = x[k] + (v[k] + 0.5 * a[k] * t) * t - load_x;
      const double contact = force_of_flank(d, rate);
      mean += (contact - drag * (v[k] + a[k] * t)) / steps;
      load_v += h * (contact - drag * load_v) / load, load_x += h * load_v;
    }
    square += mean * mean, apart += (force[k] - mean) * (force[k] - mean);
  }
  return std::sqrt(apart / square);
}

TEST(SwitchedEffect, AlongAMeasuredMotionTheLoadFollowsItsModes) {
  const auto plan = compiled("backlash");
  EXPECT_LT(deviation_along_a_motion(plan, 1), 0.05) << "a blow begins late by up to a sixteenth of a sample";
  EXPECT_EQ(deviation_along_a_motion(plan, 8), deviation_along_a_motion(plan, 1));
  ASSERT_TRUE(plan->coarser);
  EXPECT_LT(deviation_along_a_motion(plan->coarser, 8), 0.5) << "by up to a sample";
}

TEST(SwitchedEffect, TheMapOfASampleIsItsDerivative) {
  Backlash sample;
  const double x = 0.3 + gap / 2 + 3e-5, v = 0.2, free = -4, load_x = 0.3, load_v = 0.18;
  const std::vector<double> states{load_x, load_v};
  const GivenSignals given{{x, v, free, free, 0, 0, 0}};
  sample.from(states, given);
  const SampleMap& map = sample.maps()[sample.map_of(states, given)];
  constexpr double by = 1e-6;
  const Happens low = integrated(x - by, v, free, load_x, load_v),
                high = integrated(x + by, v, free, load_x, load_v);
  const std::vector<double>& of_position = map.columns[2 + GivenSignals::position];
  EXPECT_NEAR(of_position[2], (high.mean - low.mean) / (2 * by), 0.01 * stiffness);
  EXPECT_NEAR(of_position[1], (high.load_velocity - low.load_velocity) / (2 * by),
              0.01 * stiffness * sample_time / load);
  const Happens slow = integrated(x, v, free, load_x, load_v - by),
                fast = integrated(x, v, free, load_x, load_v + by);
  EXPECT_NEAR(map.columns[1][2], (fast.mean - slow.mean) / (2 * by), 0.01 * flank_damping);
}

/// Flying and pushing on either flank are known.
struct KnownBacklash : Backlash {
  KnownBacklash() {
    for (const double way : {0.0, gap, -gap}) from({0.1, 0.2}, {{0.1 + way, 0.2, 0, 0, 0, 0, 0}});
  }
};

struct DecidesAnew {
  const char* what;
  double x, v, free, load_x, load_v;
  double approach;  ///< at which a flank is met
};
constexpr DecidesAnew decides_anew[] = {
    {"touches", 0.3 + gap / 2 - 1e-5, 0.2, 0, 0.3, 0.18, 0.02},
    {"touches early in a step", 0.3 + gap / 2 - 1.3e-6, 0.2, 0, 0.3, 0.18, 0.02},
    {"leaves", 0.3 + gap / 2 + 4e-6, 0.2, -20, 0.3, 0.2 + 4e-3, 0},
    {"touches the other flank", -0.1 - gap / 2 + 8e-6, -0.1, 3, -0.1, -0.08, 0.02},
};

TEST(SwitchedEffect, ASampleThatDecidesAnewIsThatOfTheTwoBodies) {
  ASSERT_TRUE(compiled("backlash")->finer->finer);
  constexpr double unnoticed = 1.0 / 256;
  for (const DecidesAnew& s : decides_anew) {
    SCOPED_TRACE(s.what);
    KnownBacklash sample;
    expect_as_integrated(sample, s.x, s.v, s.free, s.load_x, s.load_v, s.approach, unnoticed);
  }
}

/// Blows that begin at any instant of a sample: on the average none is too weak or too strong, which would
/// seem to be another contact.
TEST(SwitchedEffect, BlowsAreNeitherLateNorEarlyOnTheAverage) {
  constexpr int blows = 97;
  constexpr double approach = 0.02;
  KnownBacklash sample;
  double missing = 0, jump = 0;
  for (int i = 0; i < blows; ++i) {
    const double distance = approach * sample_time * (i + 0.5) / blows;
    const double x = 0.3 + gap / 2 - distance, v = 0.2, load_x = 0.3, load_v = v - approach;
    const std::vector<double> result = sample.from({load_x, load_v}, {{x, v, 0, 0, 0, 0, 0}});
    missing += integrated(x, v, 0, load_x, load_v).mean - result[2];
    jump += flank_damping * approach;
  }
  EXPECT_LT(std::abs(missing / jump), 0.004) << "of the force with which a flank is met, over a sample";
}

TEST(SwitchedEffect, TheDerivativeOfASampleInWhichTheLoadLeavesIsThatOfTheMotion) {
  const DecidesAnew& s = decides_anew[2];
  const std::vector<double> states{s.load_x, s.load_v};
  const GivenSignals given{{s.x, s.v, s.free, s.free, 0, 0, 0}};
  KnownBacklash sample;
  sample.from(states, given);
  const SampleMap& map = sample.maps()[sample.map_of(states, given)];
  const auto slope = [&](double by, double x, double v, double free) {
    const Happens low = integrated(s.x - x, s.v - v, s.free - free, s.load_x, s.load_v),
                  high = integrated(s.x + x, s.v + v, s.free + free, s.load_x, s.load_v);
    return (high.mean - low.mean) / (2 * by);
  };
  const double by_position = slope(1e-8, 1e-8, 0, 0), by_velocity = slope(1e-5, 0, 1e-5, 0),
               by_acceleration = slope(1e-2, 0, 0, 1e-2);
  EXPECT_NEAR(map.columns[2 + GivenSignals::position][2], by_position, 0.05 * std::abs(by_position));
  EXPECT_NEAR(map.columns[2 + GivenSignals::velocity][2], by_velocity, 0.05 * std::abs(by_velocity));
  EXPECT_NEAR(map.columns[2 + GivenSignals::acceleration][2], by_acceleration,
              0.05 * std::abs(by_acceleration));
}

TEST(SwitchedEffect, SamplesOfOneModeShareTheirMap) {
  Backlash sample;
  const auto map_at = [&](double x, double load_x) {
    const std::vector<double> states{load_x, 0.2};
    const GivenSignals given{{x, 0.2, 0, 0, 0, 0, 0}};
    sample.from(states, given);
    return sample.map_of(states, given);
  };
  const uint32_t flying = map_at(0.1, 0.1), pushing = map_at(0.1 + gap, 0.1);
  EXPECT_NE(flying, pushing);
  EXPECT_EQ(map_at(0.5 + gap / 4, 0.5), flying);
  EXPECT_EQ(map_at(0.5 + 0.8 * gap, 0.5), pushing);
  EXPECT_EQ(sample.maps().size(), 2U);
}

}  // namespace
}  // namespace loopwright::switched_effect_test
