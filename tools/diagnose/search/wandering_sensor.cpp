#include "tools/diagnose/search/wandering_sensor.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/noise_likelihood.h"
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

/// -2 ln L as noise and offset vary.
class Misfit {
 public:
  Misfit(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start)
      : trials_(trials), fitted_(fitted), noise_{FreeNoise::all, start}, noises_(noise_.of(start).size()) {
    for (const Fitted& f : fitted) from_.push_back(without_correction_of_offset(f.gains));
  }

  WanderingOffset offset_at(const double* x) const {
    return {std::exp(x[noises_]), std::exp(x[noises_ + 1])};
  }
  double operator()(const double* x) {
    const Noise noise = noise_.at(x);
    double sum = 0;
    for (size_t t = 0; t < fitted_.size(); ++t) {
      const LinearAxis axis = with_offset(fitted_[t].axis, offset_at(x));
      const Gains to = gains_of(axis, noise, trials_.list[t].model->nominal_inertia());
      sum += noise_misfit(trials_, t, axis, fitted_[t].prediction, from_[t], to, error_);
    }
    return std::isfinite(sum) ? sum : 1e300;
  }
  /// From an offset of this size, in standard deviations of the sensor's noise. Its time is between a few
  /// samples and the length of a record.
  std::vector<double> least(double size) {
    const auto& model = *trials_.list.front().model;
    const double sensor = noise_.start.measurement.front(),
                 longest = std::max(trials_.longest_s / model.record().sample_time, 100.0),
                 shortest = criteria::least_memory_of_offset;
    std::vector<double> x = noise_.of(noise_.start), low = x, high = x;
    for (double& l : low) l -= std::log(criteria::noise_reach);
    for (double& h : high) h += std::log(criteria::noise_reach);
    const auto add = [&](double start, double least, double most) {
      x.push_back(std::log(start)), low.push_back(std::log(least)), high.push_back(std::log(most));
    };
    add(size * sensor, criteria::least_offset * sensor, criteria::most_offset * sensor);
    add(std::sqrt(shortest * longest), shortest, longest);
    return least_misfit([this](const double* at) { return (*this)(at); }, std::move(x), low, high);
  }

 private:
  const Trials& trials_;
  const std::vector<Fitted>& fitted_;
  NoiseCoordinates noise_;
  size_t noises_;  // coordinates of the noise
  std::vector<Gains> from_;
  std::vector<double> error_;
};

/// With the noise fitted once more.
double least_misfit(const Trials& trials, const Estimate& e) {
  std::vector<double> error;
  return noise_misfit(trials, *e.fitted, fit_noise(trials, *e.fitted, e.noise, FreeNoise::all), error);
}

}  // namespace

std::optional<WanderingSensor> wandering_sensor(Trials& trials, const Estimate& found) {
  constexpr int iterations = 4;
  if (trials.has_map() || !found.is_valid) return {};
  std::vector<Member> others = found.members;
  std::erase_if(others, is_own_load);
  const bool has_load = others.size() < found.members.size();
  const Estimate e =
      has_load ? fit_members(trials, std::move(others), found.noise, found.motion, iterations) : found;
  const auto has_more_states = [](const Fitted& f) { return f.axis.load_states > 0 || f.axis.steps; };
  if (!e.is_valid || std::ranges::any_of(*e.fitted, has_more_states)) return {};
  Misfit misfit(trials, *e.fitted, e.noise);
  std::vector<double> best;
  for (const double size : criteria::first_offsets) {
    std::vector<double> x = misfit.least(size);
    if (best.empty() || misfit(x.data()) < misfit(best.data())) best = std::move(x);
  }
  const WanderingOffset offset = misfit.offset_at(best.data());
  return WanderingSensor{offset.size, offset.memory_samples * trials.list.front().model->record().sample_time,
                         least_misfit(trials, found) - misfit(best.data())};
}

std::string described(const Trials& trials, const WanderingSensor& sensor) {
  const MeasuredPort& port = trials.list.front().model->record().measured.front();
  return fmt::format(
      "a {} sensor whose offset wanders by {} within {} explains the errors better: -2 ln L is {:.0f} "
      "smaller",
      port.role, shown(sensor.size, port.unit), shown(sensor.time_s, "s"), sensor.gain);
}

}  // namespace loopwright::diagnosis
