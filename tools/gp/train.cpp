#include "tools/gp/train.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "models/gp/table.h"
#include "tools/gp/warnings.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

constexpr size_t most_dense = 3000;  // a full matrix of that size takes seconds per evaluation
constexpr size_t most_shown = 1500;

struct Interrupted {};

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / double(values.size());
}
double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / double(values.size()));
}

gp::DataScale scale_of(const Training& training, const gp::Samples& samples) {
  gp::DataScale scale;
  scale.label_deviation = deviation_of(samples.labels);
  scale.period = training.period;
  std::vector<double> velocities;
  for (const gp::Point& p : samples.inputs) velocities.push_back(p[1]);
  std::ranges::sort(velocities);
  scale.velocity_range = velocities.back() - velocities.front();
  if (!(scale.velocity_range > 0)) scale.velocity_range = std::abs(velocities.front());
  if (training.pairing == VelocityPairing::plateau) {
    const auto repeated = std::ranges::unique(velocities);
    velocities.erase(repeated.begin(), repeated.end());
    double step = 1e300;
    for (size_t i = 1; i < velocities.size(); ++i) step = std::min(step, velocities[i] - velocities[i - 1]);
    if (velocities.size() > 1) scale.velocity_step = std::min(step, scale.velocity_range / 3);
  }
  return scale;
}

class Trainer {
 public:
  Trainer(const Training& training, Problems& problems, const TrainingProgress& progress)
      : training_(training), problems_(problems), progress_(progress) {}

  std::shared_ptr<const TrainedModel> run() {
    result_->samples = collect_samples(training_, problems_);
    if (!result_->samples || !are_usable(result_->samples->samples)) return nullptr;
    centred_ = result_->samples->samples;
    mean_ = mean_of(centred_.labels);
    for (double& label : centred_.labels) label -= mean_;
    kernel_ = kernel_of(training_);
    priors_ = gp::default_priors(kernel_, scale_of(training_, centred_));
    choose_priors();
    if (problems_.has_errors()) return nullptr;
    fit();
    if (training_.fits_period && !problems_.has_errors()) fit_period();
    if (problems_.has_errors()) return nullptr;
    finish();
    return result_;
  }

 private:
  Problem& problem(std::string message) {
    return problems_.error({training_.source, 0}, "", "", std::move(message));
  }

  bool are_usable(const gp::Samples& samples) {
    const size_t least = 10 * gp::parameters_of(kernel_of(training_)).size();
    if (samples.labels.size() < least) {
      auto& p = problem("there are too few samples to learn from");
      p.found = fmt::format("{} samples", samples.labels.size());
      p.expected = fmt::format("at least {}, ten a hyper-parameter", least);
      return false;
    }
    const double deviation = deviation_of(samples.labels);
    const auto [low, high] = std::ranges::minmax(samples.labels);
    const double size = std::max({std::abs(low), std::abs(high), 1e-300});
    if (!(deviation > 1e-12 * size)) {
      auto& p = problem("the labels do not vary: there is nothing to learn");
      p.found = fmt::format("{:.6g} in all {} samples", low, samples.labels.size());
      p.hint = "is it the right column?";
      return false;
    }
    return true;
  }

  void choose_priors() {
    const auto names = gp::parameter_names(kernel_);
    for (const PriorChoice& choice : training_.priors) {
      const auto at = std::ranges::find(names, choice.parameter) - names.begin();
      if (size_t(at) == names.size()) {
        auto& p = problem(fmt::format("the kernel has no parameter \"{}\"", choice.parameter));
        p.expected = fmt::format("one of {}", fmt::join(names, ", "));
        continue;
      }
      gp::Prior& prior = priors_[size_t(at)];
      if (choice.median > 0) {
        const double ratio = choice.median / prior.median;
        prior = {choice.median, prior.log_deviation, prior.low * ratio, prior.high * ratio};
      }
      if (choice.log_deviation > 0) prior.log_deviation = choice.log_deviation;
      if (choice.low > 0) prior.low = choice.low;
      if (choice.high > 0) prior.high = choice.high;
      if (!(prior.low < prior.high)) {
        auto& p = problem(fmt::format("the limits of {} leave no room", choice.parameter));
        p.found = fmt::format("from {:g} to {:g}", prior.low, prior.high);
      }
    }
  }

  /// The shortest length scales that the priors allow, along each input.
  std::array<double, 2> shortest_lengths() const {
    std::array<double, 2> shortest{1e300, 1e300};
    const gp::Kernel lowest = with_limits(&gp::Prior::low);
    for (const gp::Term& term : lowest.terms)
      for (size_t d = 0; d < 2; ++d)
        if (term.along[d].kind != gp::Shape::Kind::constant)
          shortest[d] = std::min(shortest[d], term.along[d].length);
    return shortest;
  }
  gp::Kernel with_limits(double gp::Prior::*limit) const {
    std::vector<double> values;
    for (const gp::Prior& prior : priors_) values.push_back(prior.*limit);
    return gp::with_parameters(kernel_, values);
  }

  gp::Evidence counted(gp::Evidence evidence) {
    ++evaluations_;
    // The number of evaluations of a search is unknown: the progress bar approaches its end asymptotically.
    if (progress_ && !progress_(evaluations_, evaluations_ + 20)) throw Interrupted{};
    return evidence;
  }

  void fit() {
    const gp::Kernel start = gp::at_medians(kernel_, priors_);
    std::string why_not;
    const auto statistics = gp::summarise(start, shortest_lengths(), centred_, why_not);
    if (!statistics) {
      fit_dense(start, why_not);
      return;
    }
    keep_lengths_resolved(*statistics);
    gp::StructuredEvidence evidence(*statistics);
    result_->fit = gp::fit([&](const gp::Kernel& k) { return counted(evidence(k)); },
                           gp::at_medians(kernel_, priors_), priors_);
    data_ = *statistics;
    result_->notes.assign(
        1, fmt::format("Exact, from sums over {} samples: features {} along the position ({}) "
                       "and {} along the velocity ({}), at a cost that does not depend on the "
                       "number of samples.",
                       statistics->count, statistics->bases[0].size, name(statistics->bases[0]),
                       statistics->bases[1].size, name(statistics->bases[1])));
  }
  static std::string_view name(const gp::Basis& basis) { return names_of(basis.kind)[size_t(basis.kind)]; }

  /// Lengths that the features could not resolve are excluded.
  void keep_lengths_resolved(const gp::Statistics& statistics) {
    size_t i = 0;
    for (const gp::Term& term : kernel_.terms) {
      ++i;
      for (size_t d = 0; d < 2; ++d) {
        if (term.along[d].kind == gp::Shape::Kind::constant) continue;
        gp::Prior& prior = priors_[i++];
        prior.low = std::max(prior.low, gp::resolved_length(statistics.bases[d]));
        prior.high = std::max(prior.high, 2 * prior.low);
      }
    }
  }

  void fit_dense(const gp::Kernel& start, const std::string& why_not) {
    result_->is_structured = false;
    if (centred_.labels.size() > most_dense) {
      auto& p = problem(fmt::format("the kernel has no structure that many samples could use: {}", why_not));
      p.found = fmt::format("{} samples", centred_.labels.size());
      p.expected = fmt::format("at most {} for the whole matrix", most_dense);
      p.hint = fmt::format("\"most_samples\": {} thins them evenly", most_dense);
      return;
    }
    result_->notes = {
        fmt::format("With the whole matrix of {} samples, because {}: every evaluation takes a time that "
                    "grows with their cube.",
                    centred_.labels.size(), why_not)};
    result_->fit = gp::fit([&](const gp::Kernel& k) { return counted(gp::dense_evidence(k, centred_)); },
                           start, priors_);
    data_ = centred_;
  }

  /// Log evidence plus prior at the fitted hyper-parameters, with a different period.
  double at_period(double period) {
    gp::Kernel kernel = result_->fit.kernel;
    for (gp::Term& term : kernel.terms)
      if (term.along[0].kind == gp::Shape::Kind::periodic) term.along[0].period = period;
    std::string why_not;
    const auto statistics = gp::summarise(kernel, shortest_lengths(), centred_, why_not);
    if (statistics) return counted(gp::StructuredEvidence(*statistics)(kernel)).value;
    return counted(gp::dense_evidence(kernel, centred_)).value;
  }

  /// A grid fine enough that no maximum is missed, then golden-section search; hyper-parameters are fitted
  /// again.
  void fit_period() {
    const auto [low, high] = std::ranges::minmax(centred_.inputs);
    const double span = std::max(high[0] - low[0], training_.period);
    // A change of the period by τ²/span changes the phase by one over the samples.
    const double share = training_.period_search;
    const int steps = whole_between(std::ceil(share * 8 * span / training_.period), 4, 200);
    double best = training_.period, best_value = -1e300;
    for (int i = -steps; i <= steps; ++i) {
      const double period = training_.period * (1 + share * i / steps);
      if (const double value = at_period(period); value > best_value) best = period, best_value = value;
    }
    double a = best - training_.period * share / steps, b = best + training_.period * share / steps;
    constexpr double golden = 0.6180339887498949;
    double c = b - golden * (b - a), d = a + golden * (b - a), at_c = at_period(c), at_d = at_period(d);
    while (b - a > 1e-7 * best) {
      if (at_c > at_d)
        b = d, d = c, at_d = at_c, c = b - golden * (b - a), at_c = at_period(c);
      else
        a = c, c = d, at_c = at_d, d = a + golden * (b - a), at_d = at_period(d);
    }
    const double fitted = 0.5 * (a + b);
    for (gp::Term& term : kernel_.terms)
      if (term.along[0].kind == gp::Shape::Kind::periodic) term.along[0].period = fitted;
    fit();
    result_->notes.push_back(fmt::format("The period was fitted: {:.6g} mm, where {:.6g} mm was given.",
                                         1e3 * fitted, 1e3 * training_.period));
    if (std::abs(fitted / training_.period - 1) > 0.999 * share)
      result_->learned.warnings.push_back("the fitted period lies at the end of its range: search further");
  }

  void finish() {
    LearnedModel& learned = result_->learned;
    gp::Model& model = learned.model;
    model.kernel = result_->fit.kernel;
    model.label_mean = mean_;
    model.homing_offset = training_.homing_offset;
    model.label_lag = training_.label.lag;
    for (size_t d = 0; d < 2; ++d) {
      const auto [low, high] =
          std::ranges::minmax(centred_.inputs, {}, [&](const gp::Point& p) { return p[d]; });
      model.trained[d] = {low[d], high[d]};
    }
    if (const auto* statistics = std::get_if<gp::Statistics>(&data_))
      model.data = gp::cut(*statistics, model.kernel);
    else
      model.data = data_;
    learned.title = training_.title;
    learned.label_unit = result_->samples->label_unit;
    learned.files = result_->samples->files;
    learned.data_hash = result_->samples->hash;
    learned.sample_count = centred_.labels.size();
    learned.priors = priors_;
    learned.log_evidence = result_->fit.evidence.value;
    const Score own = score(model, result_->samples->samples);
    result_->residuals = own.residuals;
    learned.residual_rms = own.rmse;
    const auto& all = result_->samples->samples;
    const size_t shown = std::min(most_shown, all.labels.size());
    for (size_t i = 0; i < shown; ++i) {
      const size_t k = i * all.labels.size() / shown;
      learned.shown.inputs.push_back(all.inputs[k]);
      learned.shown.labels.push_back(all.labels[k]);
    }
    for (const std::string& warning : result_->samples->warnings) learned.warnings.push_back(warning);
    for (std::string& warning : warnings_of(training_, *result_))
      learned.warnings.push_back(std::move(warning));
    for (std::string& limit : limits_of(*result_)) result_->notes.push_back(std::move(limit));
  }

  const Training& training_;
  Problems& problems_;
  const TrainingProgress& progress_;
  std::shared_ptr<TrainedModel> result_ = std::make_shared<TrainedModel>();
  gp::Samples centred_;
  double mean_ = 0;
  gp::Kernel kernel_;
  std::vector<gp::Prior> priors_;
  std::variant<gp::Statistics, gp::Samples> data_;
  int evaluations_ = 0;
};

}  // namespace

std::shared_ptr<const TrainedModel> train(const Training& training, Problems& problems,
                                          const TrainingProgress& progress) {
  try {
    return Trainer(training, problems, progress).run();
  } catch (const Interrupted&) {
    return nullptr;
  }
}

Score score(const gp::Model& model, const gp::Samples& samples) {
  const gp::Posterior posterior(model);
  const gp::MeanTable table(posterior);
  Score result;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < samples.labels.size(); ++i) {
    const double residual = samples.labels[i] - table(samples.inputs[i]);
    result.residuals.push_back(residual);
    sum += residual, squares += residual * residual;
    result.greatest = std::max(result.greatest, std::abs(residual));
  }
  const double n = double(std::max<size_t>(1, samples.labels.size()));
  result.rmse = std::sqrt(squares / n), result.mean = sum / n;
  result.label_deviation = samples.labels.empty() ? 0 : deviation_of(samples.labels);
  return result;
}

}  // namespace loopwright
