#include "tools/diagnose/doubt.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

constexpr double kept_error = 0.9;     // of a velocity's error from sample to sample
constexpr double deviations = 2;       // of the errors that are tried
constexpr double most_change = 2;      // of the force by them, over the white noise
constexpr double least_left = 0.2;     // of the moving rows
constexpr double shifts_s[] = {1, 2};  // each gives other errors

/// The path as it might as well have been seen.
Path seen_otherwise(const Path& path, double shift_s) {
  Path other = path;
  other.identity = 0;
  const size_t rows = path.samples(), shift = size_t(shift_s / path.sample_time);
  double error = 0;
  for (size_t k = 0; k < rows; ++k) {
    const size_t from = (k + rows - shift % rows) % rows;
    const double correction = from == 0 ? 0
                                        : path.velocity[from] - path.velocity[from - 1] -
                                              path.acceleration[from - 1] * path.sample_time;
    error = kept_error * error + correction;
    other.velocity[k] += deviations * error;
  }
  return other;
}

/// What the members that may be doubtful consume.
std::vector<double> force_along(std::vector<Member> members, const Path& path) {
  std::erase_if(members, [](const Member& m) { return !m.candidate->flies; });
  return drives_of(members, path, path.input).force;
}

}  // namespace

bool may_be_doubtful(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return m.candidate->flies; });
}

std::vector<std::vector<char>> doubtful_rows(const Trials& trials, const Estimate& estimate) {
  const double most = most_change * search_noise(trials).white;
  std::vector<std::vector<char>> doubtful;
  for (const std::shared_ptr<const Path>& path : estimate.motion.paths) {
    std::vector<char>& rows = doubtful.emplace_back(path->samples(), char(0));
    const std::vector<double> force = force_along(estimate.members, *path);
    for (const double shift : shifts_s) {
      const std::vector<double> other = force_along(estimate.members, seen_otherwise(*path, shift));
      int left = 0;
      for (size_t k = 0; k < rows.size(); ++k) {
        left = std::abs(other[k] - force[k]) > most ? samples_to_correct : std::max(0, left - 1);
        if (left > 0) rows[k] = 1;
      }
    }
  }
  return doubtful;
}

void leave_out_doubtful(Trials& trials, Estimate& estimate) {
  std::vector<std::vector<char>> usable;
  for (const Trial& trial : trials.list) usable.push_back(trial.moving);
  if (may_be_doubtful(estimate.members)) {
    const std::vector<std::vector<char>> doubtful = doubtful_rows(trials, estimate);
    size_t moving = 0, left = 0;
    for (size_t t = 0; t < doubtful.size(); ++t)
      for (size_t k = 0; k < doubtful[t].size(); ++k) {
        moving += size_t(usable[t][k]);
        if (doubtful[t][k]) usable[t][k] = 0;
        left += size_t(usable[t][k]);
      }
    // What doubts nearly everything explains nothing.
    if (double(left) < least_left * double(moving))
      for (size_t t = 0; t < usable.size(); ++t) usable[t] = trials.list[t].moving;
  }
  bool changes = false;
  for (size_t t = 0; t < usable.size(); ++t) {
    changes |= usable[t] != trials.list[t].usable;
    trials.list[t].usable = std::move(usable[t]);
  }
  if (!changes) return;
  estimate.mean_square = mean_square(trials, estimate.fitted);
  estimate.profile = profile(trials, estimate.fitted);
}

}  // namespace loopwright::diagnosis
