#include "tools/gp/warnings.h"
#include "models/real/whole.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace loopwright {
namespace {

using Warnings = std::vector<std::string>;
using gp::Shape;

void warn_of_limits(const TrainedModel& trained, Warnings& to) {
  const auto names = gp::parameter_names(trained.learned.model.kernel);
  const auto values = gp::parameters_of(trained.learned.model.kernel);
  for (size_t i = 0; i < values.size(); ++i) {
    const gp::Prior& prior = trained.learned.priors[i];
    if (gp::is_at_limit(prior, values[i]))
      to.push_back(
          fmt::format("{} ended at its limit: {:.4g}, allowed from {:.4g} to {:.4g}. The data want it "
                      "elsewhere, or do not say anything about it",
                      names[i], values[i], prior.low, prior.high));
  }
  if (!trained.fit.converged)
    to.push_back(fmt::format("the search for hyper-parameters had not ended after {} evaluations",
                             trained.fit.evaluations));
}

/// Lengths so short that the kernel fits every point separately.
void warn_of_collapse(const Training& training, const TrainedModel& trained, Warnings& to) {
  const gp::Kernel& kernel = trained.learned.model.kernel;
  const gp::Range velocities = trained.learned.model.trained[1];
  for (size_t t = 0; t < kernel.terms.size(); ++t) {
    const Shape &x = kernel.terms[t].along[0], &v = kernel.terms[t].along[1];
    if (x.kind == Shape::Kind::periodic && x.length < 0.35)
      to.push_back(
          fmt::format("the length scale of term {} along the position collapsed to {:.3g}: it follows "
                      "noise, or the period is wrong",
                      t, x.length));
    if (x.kind == Shape::Kind::squared_exponential && x.length < training.period / 20)
      to.push_back(
          fmt::format("the length scale of term {} along the position collapsed to {:.3g} mm: it follows "
                      "noise",
                      t, 1e3 * x.length));
    if (v.kind == Shape::Kind::squared_exponential && v.length < 0.1 * (velocities.high - velocities.low))
      to.push_back(
          fmt::format("the length scale of term {} along the velocity collapsed to {:.3g} m/s: it knows "
                      "nothing between the trained velocities. Measured velocities ripple with the "
                      "disturbance: pair with the plateau's, or set a lower limit",
                      t, v.length));
  }
}

void warn_of_coverage(const Training& training, const TrainedModel& trained, Warnings& to) {
  const gp::Samples& samples = trained.samples->samples;
  std::map<double, size_t> velocities;
  for (const gp::Point& p : samples.inputs)
    if (velocities.size() < 3) ++velocities[p[1]];
  const bool sees_velocity = std::ranges::any_of(trained.learned.model.kernel.terms, [](const gp::Term& t) {
    return t.along[1].kind != Shape::Kind::constant;
  });
  if (sees_velocity && velocities.size() == 1)
    to.push_back(
        fmt::format("there is one velocity only, {:.4g} m/s: what is said of others comes from the prior",
                    velocities.begin()->first));
  const gp::Range x = trained.learned.model.trained[0];
  const double span = x.high - x.low;
  const bool is_periodic = std::ranges::any_of(trained.learned.model.kernel.terms, [](const gp::Term& t) {
    return t.along[0].kind == Shape::Kind::periodic;
  });
  if (!is_periodic) return;
  if (span < training.period)
    to.push_back(
        fmt::format("the samples cover {:.3g} mm, less than one period of {:.3g} mm: the rest of it is a "
                    "guess",
                    1e3 * span, 1e3 * training.period));
}

void warn_of_period(const Training& training, const TrainedModel& trained, Warnings& to) {
  if (!(training.period > 0)) return;
  double period = training.period;
  for (const gp::Term& term : trained.learned.model.kernel.terms)
    if (term.along[0].kind == Shape::Kind::periodic) period = term.along[0].period;
  const PeriodCheck check = check_period(trained.samples->samples, period);
  if (check.best_share > check.share + 0.15 && check.best_share > 1.5 * check.share)
    to.push_back(
        fmt::format("a period of {:.4g} mm explains {:.0f} % of the labels' variance, the {:.4g} mm given "
                    "only {:.0f} %: the period is probably wrong",
                    1e3 * check.best_period, 100 * check.best_share, 1e3 * period, 100 * check.share));
}

void warn_of_fit(const TrainedModel& trained, Warnings& to) {
  const Score own = score(trained.learned.model, trained.samples->samples);
  const double explained = 1 - own.rmse * own.rmse / (own.label_deviation * own.label_deviation);
  if (explained < 0.5)
    to.push_back(fmt::format("the model explains {:.0f} % of the labels' variance only", 100 * explained));
}

}  // namespace

PeriodCheck check_period(const gp::Samples& samples, double period) {
  constexpr size_t most = 4000;
  constexpr int harmonics = 3;
  const size_t n = std::min(most, samples.labels.size());
  std::map<double, std::pair<double, double>> of_velocity;  // sum and number
  std::vector<size_t> chosen;
  for (size_t i = 0; i < n; ++i) chosen.push_back(i * samples.labels.size() / n);
  const bool has_levels = [&] {
    for (size_t i : chosen)
      if (of_velocity[samples.inputs[i][1]]; of_velocity.size() > gp::most_levels) return false;
    return true;
  }();
  const auto key = [&](size_t i) { return has_levels ? samples.inputs[i][1] : 0.0; };
  of_velocity.clear();
  for (size_t i : chosen) of_velocity[key(i)].first += samples.labels[i], of_velocity[key(i)].second += 1;
  std::vector<double> y;
  double variance = 0, low = 1e300, high = -1e300;
  for (size_t i : chosen) {
    y.push_back(samples.labels[i] - of_velocity[key(i)].first / of_velocity[key(i)].second);
    variance += y.back() * y.back();
    low = std::min(low, samples.inputs[i][0]), high = std::max(high, samples.inputs[i][0]);
  }
  // For samples spread over many periods, harmonics are nearly orthogonal: their shares add up.
  const auto share = [&](double tau) {
    double sum = 0;
    for (int h = 1; h <= harmonics; ++h) {
      double c = 0, s = 0;
      for (size_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * h * samples.inputs[chosen[i]][0] / tau;
        c += y[i] * std::cos(angle), s += y[i] * std::sin(angle);
      }
      sum += 2 * (c * c + s * s) / double(n);
    }
    return variance > 0 ? sum / variance : 0;
  };
  PeriodCheck result{share(period), period, share(period)};
  if (high - low < 2 * period) return result;
  const int steps = whole_between(4 * (high - low) / period, 20, 400);
  for (int i = 0; i <= steps; ++i) {
    const double tau = period * std::pow(2.0, double(i) / steps - 0.5);
    if (const double s = share(tau); s > result.best_share) result.best_share = s, result.best_period = tau;
  }
  return result;
}

std::vector<std::string> limits_of(const TrainedModel& trained) {
  const gp::Range v = trained.learned.model.trained[1];
  if (v.low <= 0 && v.high >= 0) return {};
  return {fmt::format(
      "All samples move {}. What holds the other way is not known: Coulomb friction and other effects of "
      "direction were learned as a constant.",
      v.low > 0 ? "forwards" : "backwards")};
}

std::vector<std::string> warnings_of(const Training& training, const TrainedModel& trained) {
  Warnings warnings;
  warn_of_period(training, trained, warnings);
  warn_of_coverage(training, trained, warnings);
  warn_of_limits(trained, warnings);
  warn_of_collapse(training, trained, warnings);
  warn_of_fit(trained, warnings);
  return warnings;
}

}  // namespace loopwright
