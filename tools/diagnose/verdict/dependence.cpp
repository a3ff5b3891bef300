/// The variables on which the remainder depends: smooth functions of each, fitted on some blocks of time and
/// tested on others.
#include <algorithm>
#include <cmath>
#include "tools/diagnose/verdict/smooth_share.h"
#include "tools/diagnose/verdict/verdict.h"
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// The remaining force, and the variables with it; means over a few samples.
struct Remainder {
  std::vector<double> force, position, velocity, acceleration, input, time;
};

Remainder remainder_of(const Trials& trials, const std::vector<Fitted>& fitted) {
  Remainder r;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Path& path = fitted[t].prediction.path;
    const size_t together =
        std::max<size_t>(1, whole_count(std::round(criteria::remainder_mean_s / path.sample_time)));
    const std::vector<double>& slow = fitted[t].prediction.slow;
    const auto add = [&](std::vector<double>& list, const std::vector<double>& of, size_t k) {
      double sum = 0;
      for (size_t i = 0; i < together; ++i) sum += of[k + i];
      list.push_back(sum / double(together));
    };
    for (size_t k = 0; k + together < path.samples(); k += together) {
      if (!trials.list[t].usable[k] || !trials.list[t].usable[k + together]) continue;
      add(r.force, slow, k), add(r.position, path.position, k), add(r.velocity, path.velocity, k);
      add(r.acceleration, path.acceleration, k), add(r.input, path.input, k);
      r.time.push_back(double(k) * path.sample_time);
    }
  }
  return r;
}

}  // namespace

std::vector<RemainderShare> dependence_of(const Trials& trials, const std::vector<Fitted>& fitted) {
  const Remainder r = remainder_of(trials, fitted);
  if (r.force.size() < criteria::least_remainder) return {};
  const double mean_s = std::max(criteria::remainder_mean_s, trials.list.front().model->record().sample_time);
  const size_t block = std::max<size_t>(1, whole_count(std::round(criteria::remainder_block_s / mean_s)));
  std::vector<RemainderShare> list;
  list.push_back({"position", smooth_share(r.force, r.position, criteria::levels_along, block)});
  if (!trials.has_map()) {
    list.push_back({"velocity", smooth_share(r.force, r.velocity, criteria::levels_of_velocity, block)});
    list.push_back(
        {"acceleration", smooth_share(r.force, r.acceleration, criteria::levels_of_acceleration, block)});
    list.push_back({"input", smooth_share(r.force, r.input, criteria::levels_of_acceleration, block)});
    list.push_back({"time", smooth_share(r.force, r.time, criteria::levels_along, block)});
  }
  const double direction = smooth_share(r.force, r.position, criteria::levels_along, block, r.velocity);
  if (direction > list.front().share + criteria::least_dependence)
    list.push_back({"position,direction", direction});
  std::ranges::stable_sort(list, std::ranges::greater{}, &RemainderShare::share);
  return list;
}

}  // namespace loopwright::diagnosis
