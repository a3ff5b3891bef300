#include "models/gp/hyperparameters.h"
#include <nlopt.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include "models/real/functions.h"

namespace loopwright::gp {
namespace {

/// The function that NLopt minimizes: -(log evidence + log prior) over the logarithms of the parameters.
struct Objective {
  const EvidenceFunction& evidence;
  const Kernel& kernel;
  std::span<const Prior> priors;
  Evidence at_best;
  double best = -std::numeric_limits<double>::infinity();
  std::vector<double> best_parameters;
  double scale = 1;
  int evaluations = 0;
  std::exception_ptr failure;  // NLopt is C: exceptions must not pass through it

  double operator()(std::span<const double> logarithms, double* gradient) {
    ++evaluations;
    std::vector<double> parameters;
    for (double x : logarithms) parameters.push_back(exponential(x));
    const Evidence e = evidence(with_parameters(kernel, parameters)), prior = log_prior(priors, parameters);
    const double value = e.value + prior.value;
    if (gradient)
      for (size_t i = 0; i < parameters.size(); ++i)
        gradient[i] = -scale * (e.gradient[i] + prior.gradient[i]);
    if (value > best) {
      best = value;
      at_best = e;
      best_parameters = parameters;
    }
    return std::isfinite(value) ? -scale * value : std::numeric_limits<double>::max();
  }
};

}  // namespace

Evidence log_prior(std::span<const Prior> priors, std::span<const double> parameters) {
  Evidence result;
  for (size_t i = 0; i < priors.size(); ++i) {
    const double z = natural_logarithm(parameters[i] / priors[i].median) / priors[i].log_deviation;
    result.value -= 0.5 * z * z;
    result.gradient.push_back(-z / priors[i].log_deviation);
  }
  return result;
}

Fit fit(const EvidenceFunction& evidence, const Kernel& from, std::span<const Prior> priors,
        const FitOptions& options) {
  Objective objective{evidence, from, priors, {}};
  std::vector<double> x = parameters_of(from), low, high;
  for (size_t i = 0; i < x.size(); ++i) {
    low.push_back(natural_logarithm(priors[i].low));
    high.push_back(natural_logarithm(priors[i].high));
    x[i] = std::clamp(natural_logarithm(x[i]), low[i], high[i]);
  }
  // The first step of SLSQP is the gradient itself, about 10⁶ for 10⁶ samples. It is scaled to 1.
  std::vector<double> slope(x.size());
  objective(x, slope.data());
  double steepest = 1;
  for (double g : slope) steepest = std::max(steepest, std::abs(g));
  objective.scale = 1 / steepest;

  const auto count = unsigned(x.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> search(nlopt_create(NLOPT_LD_SLSQP, count),
                                                                 nlopt_destroy);
  const auto minimised = [](unsigned n, const double* at, double* gradient, void* data) {
    auto& [goal, owner] = *static_cast<std::pair<Objective&, nlopt_opt>*>(data);
    try {
      return goal({at, n}, gradient);
    } catch (...) {
      goal.failure = std::current_exception();
      nlopt_force_stop(owner);
      return 0.0;
    }
  };
  std::pair<Objective&, nlopt_opt> context{objective, search.get()};
  nlopt_set_min_objective(search.get(), minimised, &context);
  nlopt_set_lower_bounds(search.get(), low.data());
  nlopt_set_upper_bounds(search.get(), high.data());
  nlopt_set_ftol_abs(search.get(), options.tolerance * objective.scale);
  nlopt_set_ftol_rel(search.get(), 1e-13);  // limit set by rounding
  nlopt_set_maxeval(search.get(), options.most_evaluations);
  double least = 0;
  const nlopt_result result = nlopt_optimize(search.get(), x.data(), &least);
  if (objective.failure) std::rethrow_exception(objective.failure);
  Fit fitted{from, objective.at_best, objective.best, objective.evaluations, false};
  if (!objective.best_parameters.empty()) fitted.kernel = with_parameters(from, objective.best_parameters);
  fitted.converged = result > 0 && result != NLOPT_MAXEVAL_REACHED;
  return fitted;
}

std::vector<Prior> default_priors(const Kernel& kernel, const DataScale& scale) {
  const double s = scale.label_deviation;
  std::vector<Prior> priors;
  const auto add = [&](double median, double log_deviation, double low = 0) {
    // Long lengths and large deviations are harmless, as the prior limits them. Short lengths are not.
    priors.push_back({median, log_deviation, std::max(low, median * exponential(-4 * log_deviation)),
                      median * exponential(8 * log_deviation)});
  };
  for (const Term& term : kernel.terms) {
    add(term.along[0].kind == Shape::Kind::constant ? 0.3 * s : s, 0.7);
    if (term.along[0].kind == Shape::Kind::periodic) add(1, 0.5, 0.25);
    if (term.along[0].kind == Shape::Kind::squared_exponential) add(scale.period / 5, 0.5);
    if (term.along[1].kind == Shape::Kind::periodic) add(1, 0.5, 0.25);
    if (term.along[1].kind == Shape::Kind::squared_exponential)
      add(scale.velocity_range / 3, 0.5, scale.velocity_step);
  }
  add(0.3 * s, 0.7);
  // Noise may be much smaller than the labels if these were filtered.
  priors.back().low = std::min(priors.back().low, 1e-3 * s);
  for (Prior& prior : priors) prior.high = std::max(prior.high, 2 * prior.low);
  return priors;
}

Kernel at_medians(const Kernel& kernel, std::span<const Prior> priors) {
  std::vector<double> medians;
  for (const Prior& prior : priors) medians.push_back(std::clamp(prior.median, prior.low, prior.high));
  return with_parameters(kernel, medians);
}

bool is_at_limit(const Prior& prior, double value) {
  const double low = natural_logarithm(prior.low), high = natural_logarithm(prior.high);
  const double margin = 1e-3 * (high - low), at = natural_logarithm(value);
  return at < low + margin || at > high - margin;
}

}  // namespace loopwright::gp
