#include "models/motion/point_to_point.h"
#include <gtest/gtest.h>
#include <fstream>
#include <random>
#include <sstream>
#include "where.h"

namespace loopwright::point_to_point_test {
namespace {

struct Case {
  MotionState from;
  double target;
  MotionLimits limits;
  double duration = 0;
};

/// Durations by Ruckig 0.17.3 (github.com/pantor/ruckig, Ruckig<1>::calculate, target at rest) for random
/// states and limits over two decades.
std::vector<Case> ruckig_cases() {
  std::ifstream file(LOOPWRIGHT_SOURCE "/tests/models/motion/ruckig_durations.csv");
  std::vector<Case> cases;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    Case c;
    text >> c.from.position >> c.from.velocity >> c.from.acceleration >> c.target >> c.limits.velocity >>
        c.limits.acceleration >> c.limits.jerk >> c.duration;
    EXPECT_TRUE(text) << line;
    cases.push_back(c);
  }
  return cases;
}

TEST(PointToPointMotion, TakesAsLongAsRuckig) {
  const auto cases = ruckig_cases();
  EXPECT_GE(cases.size(), 200u);
  for (const Case& c : cases) {
    const auto motion = PointToPointMotion::between(c.from, c.target, c.limits);
    EXPECT_NEAR(motion.duration() / c.duration, 1, 1e-12)
        << c.from.position << " " << c.from.velocity << " " << c.from.acceleration << " -> " << c.target;
  }
}

/// Random cases that keep their limits, with and without a limit on jerk.
Case random_case(std::mt19937_64& random, bool is_trapezoid) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (;;) {
    Case c;
    c.limits = {std::pow(10, between(-1, 1)), std::pow(10, between(-1, 1)),
                is_trapezoid ? HUGE_VAL : std::pow(10, between(-1, 1))};
    c.from = {between(-5, 5), between(-1, 1) * c.limits.velocity,
              is_trapezoid ? 0 : between(-1, 1) * c.limits.acceleration};
    c.target = random() % 4 == 0 ? c.from.position + between(-0.1, 0.1) : between(-5, 5);
    const double later =
        c.from.velocity + c.from.acceleration * std::fabs(c.from.acceleration) / (2 * c.limits.jerk);
    if (std::fabs(later) <= c.limits.velocity) return c;
  }
}

TEST(PointToPointMotion, KeepsItsLimitsAndJoinsSmoothly) {
  std::mt19937_64 random(10);
  for (int i = 0; i < 4000; ++i) {
    const Case c = random_case(random, i % 2 == 0);
    const auto motion = PointToPointMotion::between(c.from, c.target, c.limits);
    const double size = 1 + std::fabs(c.from.position) + std::fabs(c.target);
    double begin = 0;
    MotionState last = c.from;
    for (int phase = 0; phase < PointToPointMotion::phases; ++phase) {
      const double end = motion.end_of_phase(phase);
      ASSERT_GE(end, begin);
      if (end == begin) continue;
      const MotionState first = motion.state_at(begin, phase);
      ASSERT_NEAR(first.position, last.position, 1e-12 * size) << "case " << i << " phase " << phase;
      ASSERT_NEAR(first.velocity, last.velocity, 1e-12 * (1 + c.limits.velocity));
      if (std::isfinite(c.limits.jerk)) {
        ASSERT_NEAR(first.acceleration, last.acceleration, 1e-12 * (1 + c.limits.acceleration));
      }
      for (int k = 0; k <= 8; ++k) {
        const MotionState state = motion.state_at(begin + (end - begin) * k / 8, phase);
        ASSERT_LE(std::fabs(state.velocity), c.limits.velocity * (1 + 1e-12));
        ASSERT_LE(std::fabs(state.acceleration), c.limits.acceleration * (1 + 1e-12));
      }
      begin = end, last = motion.state_at(end, phase);
    }
    ASSERT_NEAR(last.position, c.target, 1e-12 * size);
    const MotionState end = motion.state_at(motion.duration());
    ASSERT_TRUE(end.position == c.target && end.velocity == 0 && end.acceleration == 0) << "exactly";
  }
}

TEST(PointToPointMotion, NoMotionOfTheSameLimitsIsFaster) {
  // Planning again on the way must give the same end: a faster rest of the way would have been found before.
  std::mt19937_64 random(11);
  for (int i = 0; i < 2000; ++i) {
    const Case c = random_case(random, i % 2 == 0);
    const auto motion = PointToPointMotion::between(c.from, c.target, c.limits);
    const double now = motion.duration() * std::uniform_real_distribution(0.0, 1.0)(random);
    const auto rest = PointToPointMotion::between(motion.state_at(now), c.target, c.limits);
    // Near the end an error δ of the position costs a motion of its own, of some (δ/j)^(1/3) or (δ/a)^(1/2).
    const double error = 1e-15 * (1 + std::fabs(c.from.position) + std::fabs(c.target));
    const double costs = std::isfinite(c.limits.jerk) ? std::cbrt(error / c.limits.jerk)
                                                      : std::sqrt(error / c.limits.acceleration);
    ASSERT_NEAR(now + rest.duration(), motion.duration(), 10 * costs) << "case " << i;
  }
}

TEST(PointToPointMotion, IsTheTextbookTrapezoid) {
  // 1 m at 0.5 m/s and 1 m/s²: 0.5 s up, 0.5 s down, 0.75 m in between take 1.5 s.
  const auto motion = PointToPointMotion::between({}, 1, {0.5, 1, HUGE_VAL});
  EXPECT_NEAR(motion.duration(), 2.5, 1e-15);
  EXPECT_NEAR(motion.state_at(0.25).velocity, 0.25, 1e-15);
  EXPECT_NEAR(motion.state_at(1).velocity, 0.5, 1e-15);
  EXPECT_NEAR(motion.state_at(2.25).position, 1 - 0.25 * 0.25 / 2, 1e-15);
  // A triangle where the way is too short: 2 √(d/a).
  EXPECT_NEAR(PointToPointMotion::between({}, -0.04, {0.5, 1, HUGE_VAL}).duration(), 0.4, 1e-15);
}

TEST(PointToPointMotion, IsTheTextbookDoubleS) {
  // All limits are reached: T = d/v + v/a + a/j (L. Biagiotti, C. Melchiorri, 2008, section 3.4).
  EXPECT_NEAR(PointToPointMotion::between({}, 10, {5, 10, 30}).duration(), 10.0 / 5 + 5.0 / 10 + 10.0 / 30,
              1e-14);
  // Only jerk: four equal phases of length (d/2j)^(1/3).
  EXPECT_NEAR(PointToPointMotion::between({}, 2, {100, 100, 1}).duration(), 4, 1e-14);
}

TEST(PointToPointMotion, StaysWhereItIs) {
  for (const double jerk : {1.0, HUGE_VAL}) {
    const auto motion = PointToPointMotion::between({3, 0, 0}, 3, {1, 1, jerk});
    EXPECT_EQ(motion.duration(), 0);
    EXPECT_EQ(motion.state_at(0).position, 3);
  }
}

}  // namespace
}  // namespace loopwright::point_to_point_test
