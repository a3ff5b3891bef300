#include "models/motion/timed_motion.h"
#include <gtest/gtest.h>
#include <fstream>
#include <random>
#include <sstream>
#include "models/motion/via_points.h"
#include "where.h"

namespace loopwright::timed_motion_test {
namespace {

struct Axis {
  MotionState from;
  double target, end_velocity;
  MotionLimits limits;
};

std::vector<TimedMotion> motions_of(const std::vector<Axis>& axes) {
  std::vector<TimedMotion> result;
  for (const Axis& axis : axes) result.emplace_back(axis.from, axis.target, axis.end_velocity, axis.limits);
  return result;
}

/// Three axes from rest to rest (0), from any state to rest (1), and from any state to any velocity (2), by
/// Ruckig 0.17.3 (Ruckig<3>::calculate, synchronized in time).
TEST(TimedMotion, AxesArriveTogetherAsSoonAsThoseOfRuckig) {
  std::ifstream file(LOOPWRIGHT_SOURCE "/tests/models/motion/ruckig_synchronized.csv");
  std::string line;
  std::getline(file, line);
  size_t cases = 0;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    int kind = 0;
    text >> kind;
    std::vector<Axis> axes(3);
    for (Axis& axis : axes)
      text >> axis.from.position >> axis.from.velocity >> axis.from.acceleration >> axis.target >>
          axis.limits.velocity >> axis.limits.acceleration >> axis.limits.jerk >> axis.end_velocity;
    std::array<double, 3> fastest{};
    double duration = 0;
    text >> fastest[0] >> fastest[1] >> fastest[2] >> duration;
    ASSERT_TRUE(text) << line;
    const auto motions = motions_of(axes);
    EXPECT_NEAR(common_motion(motions).duration / duration, 1, 1e-10) << line;
    for (size_t i = 0; kind < 2 && i < 3; ++i)
      EXPECT_NEAR(motions[i].fastest() / fastest[i], 1, 1e-10) << line;
    ++cases;
  }
  EXPECT_GE(cases, 200u);
}

Axis random_axis(std::mt19937_64& random, bool is_trapezoid, bool rests) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (;;) {
    Axis axis;
    axis.limits = {std::pow(10, between(-1, 1)), std::pow(10, between(-1, 1)),
                   is_trapezoid ? HUGE_VAL : std::pow(10, between(-1, 1))};
    axis.from = {between(-5, 5), rests ? 0 : between(-1, 1) * axis.limits.velocity,
                 is_trapezoid || rests ? 0 : between(-1, 1) * axis.limits.acceleration};
    axis.target = random() % 5 == 0 ? axis.from.position : between(-5, 5);
    axis.end_velocity = random() % 2 ? 0 : between(-1, 1) * axis.limits.velocity;
    const double later = axis.from.velocity +
                         axis.from.acceleration * std::fabs(axis.from.acceleration) / (2 * axis.limits.jerk);
    if (std::fabs(later) <= axis.limits.velocity) return axis;
  }
}

/// The motion keeps its limits, joins without a jump, and ends exactly.
void expect_sound(const PointToPointMotion& motion, const Axis& axis, double duration) {
  const double size = 1 + std::fabs(axis.from.position) + std::fabs(axis.target) + axis.limits.velocity;
  double begin = 0;
  MotionState last = axis.from;
  for (int phase = 0; phase < PointToPointMotion::phases; ++phase) {
    const double end = motion.end_of_phase(phase);
    ASSERT_GE(end, begin);
    if (end == begin) continue;
    const MotionState first = motion.state_at(begin, phase);
    ASSERT_NEAR(first.position, last.position, 1e-11 * size) << "phase " << phase;
    ASSERT_NEAR(first.velocity, last.velocity, 1e-11 * size) << "phase " << phase;
    if (std::isfinite(axis.limits.jerk)) {
      ASSERT_NEAR(first.acceleration, last.acceleration, 1e-6 * axis.limits.acceleration);
    }
    for (int k = 0; k <= 8; ++k) {
      const MotionState state = motion.state_at(begin + (end - begin) * k / 8, phase);
      ASSERT_LE(std::fabs(state.velocity), axis.limits.velocity * (1 + 1e-9));
      ASSERT_LE(std::fabs(state.acceleration), axis.limits.acceleration * (1 + 1e-9));
    }
    begin = end, last = motion.state_at(end, phase);
  }
  EXPECT_EQ(motion.duration(), duration);
  EXPECT_EQ(last.position, axis.target);
  EXPECT_EQ(last.velocity, axis.end_velocity);
}

TEST(TimedMotion, KeepsLimitsJoinsSmoothlyAndEndsExactly) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 3000; ++i) {
    std::vector<Axis> axes;
    for (size_t k = 0; k < 1 + random() % 4; ++k) axes.push_back(random_axis(random, i % 2 == 0, i % 3 == 0));
    const auto motions = motions_of(axes);
    const CommonMotion common = common_motion(motions);
    ASSERT_TRUE(std::isfinite(common.duration)) << i;
    double slowest = 0;
    for (size_t k = 0; k < axes.size(); ++k) {
      SCOPED_TRACE(testing::Message() << "case " << i << " axis " << k);
      slowest = std::max(slowest, motions[k].fastest());
      ASSERT_NO_FATAL_FAILURE(
          expect_sound(motions[k].motion(common.duration, common.cruises[k]), axes[k], common.duration));
    }
    EXPECT_GE(common.duration, slowest);
    if (i % 3 == 0 && std::ranges::all_of(axes, [](const Axis& a) { return a.end_velocity == 0; })) {
      EXPECT_EQ(common.duration, slowest) << "from rest to rest every longer time is possible";
    }
  }
}

TEST(TimedMotion, AnAxisThatBrakesForItsTargetCannotComeALittleLater) {
  // From 1 m/s it needs 0.55 m to stop, and a little more if it takes its acceleration back on the way.
  const TimedMotion motion({0, 1, 0}, 0.551, 0, {1, 1, 10});
  std::vector<bool> possible;
  for (double time = motion.fastest() + 1e-3; time < 2 * motion.fastest(); time += 1e-3)
    if (const bool is_possible = motion.cruise_for(time).has_value();
        possible.empty() || possible.back() != is_possible)
      possible.push_back(is_possible);
  EXPECT_FALSE(motion.cruise_for(motion.fastest() - 1e-6));
  EXPECT_GE(possible.size(), 2u) << "there is a gap";
  EXPECT_TRUE(possible.back());
}

TEST(ViaPointMotion, LimitsOfAnySizeDoNoHarm) {
  for (const double velocity : {5e-324, 1e-30, 1e30, 1.7e308})
    for (const double acceleration : {5e-324, 1e-300, 1e300, 1.7e308})
      for (const double jerk : {5e-324, 1.0, 1e300, HUGE_VAL})
        EXPECT_GE(
            ViaPointMotion({{0, 0}, {0.02, 0.08}, {0.15, 0.1}}, {{velocity, acceleration, jerk}, {1, 6, 200}})
                .duration(),
            0)
            << "or infinite, which the block reports";
}

TEST(ViaPointMotion, PointsOnTheWayCostNothing) {
  const std::vector<MotionLimits> limits{{1, 5, 50}, {2, 10, 100}};
  const ViaPointMotion motion({{0, 0}, {0.3, 0.6}, {0.9, 1.8}, {1.4, 2.8}}, limits);
  EXPECT_NEAR(motion.duration(), PointToPointMotion::between({}, 1.4, limits[0]).duration(), 1e-6);
}

TEST(ViaPointMotion, PassesItsPointsWithinTheLimits) {
  std::mt19937_64 random(13);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int i = 0; i < 24; ++i) {
    const size_t axes = 1 + random() % 3, count = 2 + random() % 5;
    std::vector<std::vector<double>> points(count);
    for (auto& point : points)
      for (size_t k = 0; k < axes; ++k) point.push_back(between(-1, 1));
    std::vector<MotionLimits> limits;
    for (size_t k = 0; k < axes; ++k)
      limits.push_back({between(0.5, 2), between(2, 10), i % 2 ? HUGE_VAL : between(20, 200)});
    const ViaPointMotion motion(points, limits);
    double with_stops = 0;
    for (size_t part = 0; part + 1 < count; ++part) {
      double slowest = 0;
      for (size_t k = 0; k < axes; ++k) {
        const Axis axis{{points[part][k], motion.velocity_at(part, k), 0},
                        points[part + 1][k],
                        motion.velocity_at(part + 1, k),
                        limits[k]};
        const double end = part + 1 == motion.parts() ? motion.duration() : motion.begin_of(part + 1);
        const PointToPointMotion& moved = motion.motion(part, k);
        ASSERT_NEAR(moved.duration(), end - motion.begin_of(part), 1e-12);
        ASSERT_NO_FATAL_FAILURE(expect_sound(moved, axis, moved.duration()));
        for (double t = 0; t < moved.duration(); t += moved.duration() / 50) {
          const double way = axis.target - axis.from.position;
          ASSERT_GE(moved.state_at(t).velocity * way, -1e-6) << "an axis moves back";
        }
        slowest = std::max(
            slowest,
            PointToPointMotion::between({points[part][k], 0, 0}, points[part + 1][k], limits[k]).duration());
      }
      with_stops += slowest;
    }
    EXPECT_LE(motion.duration(), with_stops * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace loopwright::timed_motion_test
