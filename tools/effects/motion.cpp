#include "tools/effects/motion.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {
namespace {

using std::numbers::pi;

/// One stroke: v rises along half a cosine, stays constant, and falls again.
struct Stroke {
  double way, speed, ramp, cruise;  // ramp, cruise: s

  Stroke(double distance, double wanted_speed, double acceleration) : way(distance) {
    const double size = std::abs(distance);
    speed = std::min(wanted_speed, std::sqrt(2 * acceleration * size / pi));
    ramp = pi * speed / (2 * acceleration);
    cruise = std::max(size / speed - ramp, 0.0);
  }
  double duration() const { return 2 * ramp + cruise; }
  double at(double t) const {
    const auto rising = [&](double s) { return 0.5 * speed * (s - ramp / pi * std::sin(pi * s / ramp)); };
    double gone = 0;
    if (t < ramp)
      gone = rising(t);
    else if (t < ramp + cruise)
      gone = 0.5 * speed * ramp + speed * (t - ramp);
    else
      gone = std::abs(way) - rising(std::max(duration() - t, 0.0));
    return std::copysign(gone, way);
  }
};

void append(Motion& motion, const Stroke& stroke, double pause) {
  const double begin = motion.position.back();
  const auto samples = whole_count(std::ceil(stroke.duration() / motion.sample_time));
  for (size_t k = 1; k <= samples; ++k)
    motion.position.push_back(begin + stroke.at(std::min(double(k) * motion.sample_time, stroke.duration())));
  motion.position.insert(motion.position.end(), whole_count(std::round(pause / motion.sample_time)),
                         begin + stroke.way);
}

/// Sweeps through the frequencies at constant octaves per time.
void add_chirp(Motion& motion, const SeparatingExperiment& e, double amplitude) {
  const double duration = double(motion.position.size()) * motion.sample_time;
  const double octaves = std::log(e.chirp_to_hz / e.chirp_from_hz);
  for (size_t k = 0; k < motion.added_force.size(); ++k) {
    const double s = double(k) * motion.sample_time / duration;
    motion.added_force[k] =
        amplitude * std::sin(2 * pi * e.chirp_from_hz * duration * (std::exp(octaves * s) - 1) / octaves);
  }
}

}  // namespace

Motion motion_of(const SeparatingExperiment& e, const RecordSizes& sizes) {
  Motion motion{sizes.sample_time, {}, {}, e.added_mass * sizes.machine_mass};
  const double distance = e.distance * sizes.stroke;
  const double middle = 0.5 * (sizes.lowest_position + sizes.highest_position);
  motion.position.push_back(middle - 0.5 * distance);
  motion.position.insert(motion.position.end(), whole_count(std::round(e.pause_s / sizes.sample_time)),
                         motion.position.back());
  for (int pass = 0; pass < e.passes; ++pass)
    for (double speed : e.speeds)
      for (double way : {distance, -distance})
        append(motion, Stroke(way, speed * sizes.top_speed, e.acceleration * sizes.top_acceleration),
               e.pause_s);
  motion.added_force.assign(motion.position.size(), 0.0);
  if (e.chirp_amplitude > 0) add_chirp(motion, e, e.chirp_amplitude * sizes.force_level);
  return motion;
}

}  // namespace loopwright
