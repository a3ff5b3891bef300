#include "tools/diagnose/search/rest.h"
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

using namespace criteria;

/// [rows]
size_t rows_in(double seconds, double sample_time, size_t least) {
  return std::max(least, whole_count(std::round(seconds / sample_time)));
}

AtRest at_rest(const std::vector<Member>& members) {
  AtRest result = AtRest::free;
  for (const Member& member : members) {
    if (member.candidate->at_rest == AtRest::gives) return AtRest::gives;
    if (member.candidate->at_rest == AtRest::holds) result = AtRest::holds;
  }
  return result;
}

/// Something held the axis that the members leave free.
double against_free(const Trials& trials, const std::vector<Fitted>& fitted, double least_rest_s) {
  double sum = 0, count = 0;
  const size_t ports = trials.ports();
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const double least_rows = least_rest_s / trial.model->record().sample_time;
    // With other noise than the first guess the predictor forgets its start later.
    const size_t from = whole_count(std::ceil(correction * correction_time(fitted[t].axis, fitted[t].gains)));
    for (size_t k = 0, resting = 0; k < trial.held_out_from; ++k) {
      resting = trial.at_rest[k] && k >= from ? resting + 1 : 0;
      for (size_t p = 0; p < ports && resting > 0 && double(resting) > least_rows; ++p)
        sum += std::pow(fitted[t].white[k * ports + p], 2), count += 1;
    }
  }
  // Below one the noise is at the least that is assumed, and errors within it contradict nothing.
  const double in_motion = std::max(1.0, mean_square(trials, fitted));
  return count > 0 ? count * std::log(std::max(1.0, sum / count / (worse_at_rest * in_motion))) : 0;
}

/// Rows in which the axis was looked at while it rested.
struct Glances {
  size_t least_rest = 0, apart = 0, length = 0;  ///< [rows] before the first; of an increase; of a glance
};

/// Whether most of a glance goes in one direction: counts hide some of a slow slide, and noise turns some.
bool is_slide(size_t forward, size_t backward, size_t length) {
  return 2 * std::max(forward, backward) >= length &&
         std::max(forward, backward) >= 3 * std::min(forward, backward);
}

/// Mean square of the increase of the motion of the axis at rest in `lag` samples over that in the previous
/// `lag` samples: a creep at constant speed does not contribute. Median of means over short intervals,
/// because a held axis slips now and then; but an axis that moves on in one direction slides, and that a
/// slide is free says nothing. Nor does the first interval of a rest, in which it comes to that.
struct Swerve {
  double square = 0;
  size_t glances = 0;
};
Swerve swerve_at_rest(const Trials& trials, size_t lag, const Glances& at) {
  constexpr double median_to_mean = 0.9;
  std::vector<double> glances;
  for (const Trial& trial : trials.list) {
    const MeasuredPort* position = trial.model->record().find("position");
    double sum = 0;
    size_t forward = 0, backward = 0;
    for (size_t k = 0, resting = 0; position && k < trial.held_out_from; ++k) {
      resting = trial.at_rest[k] ? resting + 1 : 0;
      if (resting <= at.least_rest + 2 * at.apart + at.length) {
        sum = 0, forward = backward = 0;
        continue;
      }
      const double* x = position->value.data() + k;
      sum += std::pow(*x - 2 * *(x - lag) + *(x - 2 * lag), 2) / double(at.length);
      forward += size_t(*x > *(x - at.apart)), backward += size_t(*x < *(x - at.apart));
      if ((resting - at.least_rest - 2 * at.apart) % at.length != 0) continue;
      if (!is_slide(forward, backward, at.length)) glances.push_back(sum);
      sum = 0, forward = backward = 0;
    }
  }
  if (glances.empty()) return {};
  const auto middle = glances.begin() + std::ptrdiff_t(glances.size() / 2);
  std::ranges::nth_element(glances, middle);
  return {*middle / median_to_mean, glances.size()};
}

/// The axis moves as if nothing held it.
double against_held(const Trials& trials, const Noise& noise, double least_rest_s) {
  const AxisModel& model = *trials.list.front().model;
  const double T = model.record().sample_time;
  const size_t apart = rows_in(deviation_s, T, 2);
  const Glances glances{rows_in(least_rest_s, T, 0), apart, rows_in(glance_s, T, 3 * apart)};
  const Swerve swerve = swerve_at_rest(trials, apart, glances);
  if (swerve.glances == 0) return 0;
  double square = 0;  // of 1/mass: its mean over the records
  for (const Trial& trial : trials.list)
    square += std::pow(trial.model->nominal_inertia(), -2) / double(trials.list.size());
  const double kick = noise.white * std::sqrt(square) * T * T;
  // From sample to sample hardly anything but the sensor changes, including its steps.
  const double sensor =
      std::max(swerve_at_rest(trials, 1, glances).square, 6 * std::pow(noise.measurement[0], 2));
  const double free = kick * kick * 2 * std::pow(double(apart), 3) / 3, seen = swerve.square - sensor;
  if (seen < least_freedom * free || seen > most_freedom * free || seen < sensor) return 0;
  return double(swerve.glances * glances.length) / double(2 * apart) * std::log1p(seen / sensor);
}

}  // namespace

double against_at_rest(const Trials& trials, const std::vector<Member>& members,
                       const std::vector<Fitted>& fitted, const Noise& noise, double least_rest_s) {
  if (trials.nominal_holds) return 0;
  switch (at_rest(members)) {
    case AtRest::free:
      return against_free(trials, fitted, least_rest_s);
    case AtRest::holds:
      return against_held(trials, noise, least_rest_s);
    default:
      return 0;
  }
}

}  // namespace loopwright::diagnosis
