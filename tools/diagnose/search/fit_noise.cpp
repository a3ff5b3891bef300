/// The likelihood of the noise, from errors produced with one set of gains.
#include <nlopt.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/same_sums.h"  // for the whole program
#include "tools/diagnose/search/noise_likelihood.h"

namespace loopwright::diagnosis {

std::vector<double> NoiseCoordinates::of(const Noise& noise) const {
  std::vector<double> x{std::log(noise.white)};
  if (free == FreeNoise::white) return x;
  if (free == FreeNoise::white_and_slow) return x.push_back(std::log(noise.slow())), x;
  x.push_back(std::log(free == FreeNoise::with_random_walk ? noise.step : noise.slow()));
  for (double m : noise.measurement) x.push_back(std::log(m));
  if (free == FreeNoise::all) x.push_back(std::log(noise.memory_samples()));
  return x;
}

Noise NoiseCoordinates::at(const double* x) const {
  Noise noise = start;
  noise.white = std::exp(x[0]);
  if (free == FreeNoise::white) return noise.step = start.step / start.white * noise.white, noise;
  if (free != FreeNoise::white_and_slow)
    for (size_t p = 0; p < noise.measurement.size(); ++p) noise.measurement[p] = std::exp(x[2 + p]);
  if (free == FreeNoise::with_random_walk) return noise.step = std::exp(x[1]), noise;
  if (free == FreeNoise::all) noise.memory = std::exp(-std::exp(-x[2 + noise.measurement.size()]));
  noise.step = std::exp(x[1]) * std::sqrt(1 - noise.memory * noise.memory);
  return noise;
}

double noise_misfit(const Trials& trials, size_t record, const LinearAxis& axis, const Prediction& prediction,
                    const Gains& from, const Gains& to, std::vector<double>& error) {
  const Trial& trial = trials.list[record];
  const size_t ports = trials.ports();
  with_gains(axis, prediction, from, to, error);
  whiten(error, to);
  trials.work->add(error.size(), 3 * Work::of_a_response + (to.rows ? Work::of_gains : 0));
  size_t rows = 0;
  double squares = 0, log_determinants = 0;
  for (size_t k = 0; k < std::min(trial.held_out_from, error.size() / ports); ++k) {
    if (!trial.usable[k]) continue;
    ++rows;
    if (to.rows) log_determinants += to.log_determinant_at(k);
    for (size_t p = 0; p < ports; ++p) squares += error[k * ports + p] * error[k * ports + p];
  }
  return squares + (to.rows ? log_determinants : double(rows) * to.log_determinant);
}

std::vector<double> least_misfit(const std::function<double(const double*)>& misfit,
                                 std::vector<double> start, const std::vector<double>& low,
                                 const std::vector<double>& high) {
  const auto evaluate = [](unsigned, const double* x, double*, void* data) {
    return (*static_cast<const std::function<double(const double*)>*>(data))(x);
  };
  nlopt_opt optimiser = nlopt_create(NLOPT_LN_BOBYQA, unsigned(start.size()));
  nlopt_set_min_objective(optimiser, evaluate, const_cast<void*>(static_cast<const void*>(&misfit)));
  nlopt_set_lower_bounds(optimiser, low.data());
  nlopt_set_upper_bounds(optimiser, high.data());
  nlopt_set_initial_step1(optimiser, 0.7);
  constexpr double flat = 0.02;  // [-2 ln L] A turn that gains less is the last one.
  nlopt_set_ftol_abs(optimiser, flat);
  nlopt_set_maxeval(optimiser, 60 * int(start.size()));
  double value = 0;
  nlopt_optimize(optimiser, start.data(), &value);
  nlopt_destroy(optimiser);
  return start;
}

double noise_misfit(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& noise,
                    std::vector<double>& error) {
  double sum = 0;
  for (size_t t = 0; t < fitted.size(); ++t) {
    const Fitted& f = fitted[t];
    const Gains gains = gains_of(f.axis, noise, trials.list[t].model->nominal_inertia());
    sum += noise_misfit(trials, t, f.axis, f.prediction, f.gains, gains, error);
  }
  return std::isfinite(sum) ? sum : 1e300;
}

namespace {

/// Of a slow force: spectral density at zero frequency over variance, in sample times.
double samples_alike(const Noise& noise) { return (1 + noise.memory) / (1 - noise.memory); }

/// [white force of a row] That a slow force is compared with: the faster the rows, the louder is each beside
/// a force that lasts longer than that of an amplifier, which is compared with the mean over some rows.
double white_beside(const Trials& trials, const Noise& noise) {
  const double sample_time = trials.list.front().model->record().sample_time;
  const double memory = noise.memory_samples() * sample_time, usual = criteria::longest_memory_of_amplifier_s;
  const double longer = std::clamp(memory / usual - 1, 0.0, 1.0);
  const double mean_over = sample_time + longer * std::max(0.0, criteria::judged_row_s - sample_time);
  return std::sqrt(sample_time / mean_over);
}

bool is_slow_force_noise(const Trials& trials, const Noise& noise) {
  const double slow = noise.slow() / noise.white;
  return is_soon_forgotten(noise) || slow <= criteria::most_slow_noise * white_beside(trials, noise) ||
         slow * slow * samples_alike(noise) <= criteria::most_slow_density;
}

/// Whether another noise predicts no worse than chance lets it.
bool is_as_likely(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& other,
                  const Noise& noise) {
  std::vector<double> error;
  const double lost = noise_misfit(trials, fitted, other, error) - noise_misfit(trials, fitted, noise, error);
  return lost < criteria::most_lost_as_white;
}

/// As much white noise as a slow force has beside it that is noise. A sensor's noise can hide how much there
/// is: the likelihood is flat then. Empty: it predicts worse.
std::optional<Noise> with_louder_white(const Trials& trials, const std::vector<Fitted>& fitted,
                                       const Noise& noise) {
  Noise louder = noise;
  louder.white = noise.slow() / (criteria::most_slow_noise * white_beside(trials, noise));
  return is_as_likely(trials, fitted, louder, noise) ? std::optional(louder) : std::nullopt;
}

/// All of a slow force counted as white noise, as loud as the errors ask for: a sensor that shows the force
/// of every row asks for the same variance, one with coarse counts for more, which does as much to a slow
/// motion.
Noise as_white(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& noise) {
  Noise white = noise;
  white.white = std::hypot(noise.white, noise.slow());
  white.step = criteria::next_to_no_slow_noise * white.white * std::sqrt(1 - noise.memory * noise.memory);
  return fit_noise(trials, fitted, white, FreeNoise::white);
}

}  // namespace

Noise search_noise(const Trials& trials) {
  Noise noise = trials.noise;
  noise.white = std::max(noise.white, criteria::least_search_noise * trials.force_rms);
  if (!trials.noise_is_seen)
    noise.white = std::min(noise.white, criteria::most_search_noise * trials.force_rms);
  const double sample_time = trials.list.front().model->record().sample_time;
  noise.memory = std::exp(-sample_time / criteria::slow_memory_s);
  noise.step = criteria::usual_slow_noise * noise.white * std::sqrt(1 - noise.memory * noise.memory);
  return noise;
}

Noise fit_noise(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start, FreeNoise free) {
  const NoiseCoordinates coordinates{free, start};
  std::vector<double> x = coordinates.of(start), low = x, high = x, error;
  for (size_t i = 0; i < x.size(); ++i)
    low[i] -= std::log(criteria::noise_reach), high[i] += std::log(criteria::noise_reach);
  // If the sensor's quantization is the only noise, the force noise would go to zero.
  low[0] = std::max(low[0], std::log(criteria::least_white_noise * trials.force_rms));
  x[0] = std::max(x[0], low[0]), high[0] = std::max(high[0], x[0]);
  const auto misfit = [&](const double* at) {
    return noise_misfit(trials, fitted, coordinates.at(at), error);
  };
  return coordinates.at(least_misfit(misfit, std::move(x), low, high).data());
}

bool is_soon_forgotten(const Noise& noise) { return noise.memory_samples() < criteria::quick_noise; }

bool is_remainder_noise(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start) {
  const Noise noise = fit_noise(trials, fitted, start, FreeNoise::all);
  return is_slow_force_noise(trials, noise) || with_louder_white(trials, fitted, noise) ||
         is_as_likely(trials, fitted, as_white(trials, fitted, noise), noise);
}

Noise fit_noise_alone(const Trials& trials, const std::vector<Fitted>& fitted, const Noise& start,
                      FreeNoise free) {
  // If it is nearly zero, or was set to zero, the likelihood is too flat to recover it.
  Noise from = start;
  from.step =
      std::max(from.step, criteria::usual_slow_noise * from.white * std::sqrt(1 - from.memory * from.memory));
  Noise noise = fit_noise(trials, fitted, from, free);
  if (is_slow_force_noise(trials, noise)) return noise;
  const Noise white = as_white(trials, fitted, noise);
  if (is_as_likely(trials, fitted, white, noise)) return white;
  return with_louder_white(trials, fitted, noise).value_or(white);
}

}  // namespace loopwright::diagnosis
