#include "tools/diagnose/verdict/site_errors.h"
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_simulation.h"
#include "tools/diagnose/search/site_whiteness.h"

namespace loopwright::diagnosis {
namespace {

class MeanSquare {
 public:
  void add(double square) {
    if (std::isfinite(square)) sum_ += square, ++count_;
  }
  double mean() const { return count_ ? sum_ / double(count_) : 0; }
  double root() const { return std::sqrt(mean()); }

 private:
  double sum_ = 0;
  size_t count_ = 0;
};

void use_simulation(SiteFitter& fitter, const SiteHypothesis& h, SiteErrors& errors) {
  const auto simulation = simulation_errors(fitter, h);
  errors.diverges = !simulation;
  if (!simulation) return;
  errors.predicted = simulation->fitted, errors.simulated = simulation->judged();
  errors.held_out = simulation->held_out.empty() ? errors.held_out : simulation->held_out;
  errors.noise = h.noise.measurement;
  errors.expected_simulated = errors.noise;
  for (const SlowNoise& slow : h.noise.slow) {
    const auto output = size_t(slow.output);
    errors.leaves_slow_error |= slow.size > h.noise.measurement[output];
    errors.expected_simulated[output] = std::hypot(errors.expected_simulated[output], slow.size);
  }
}

/// Whether predictions and simulations miss the output by no more than its counts do. Those of a slow signal
/// follow each other, and are no sign of anything missing.
bool are_errors_of_counts(const SiteErrors& errors, const RecordedOutput& output, size_t j) {
  const double most = most_error_of_counts(output);
  return !errors.diverges && errors.predicted[j] < most && !(errors.held_out[j] > most) &&
         errors.simulated[j] < most;
}

}  // namespace

SiteErrors errors_of(SiteFitter& fitter, SiteHypothesis h) {
  SiteErrors errors;
  SitePass pass;
  errors.diverges = !fitter.pass(h, false, pass);
  if (errors.diverges) return errors;
  const SignalRecord& record = fitter.model().record();
  const size_t fitted = record.held_out_from, rows = record.rows();
  const std::vector<bool> settles = record.settling_rows();
  MeanSquare all, all_held_out;
  std::vector<double> portmanteaus;
  for (size_t j = 0; j < pass.outputs; ++j) {
    MeanSquare predicted, held_out, noise;
    for (size_t k = 0; k < rows; ++k) {
      const size_t at = k * pass.outputs + j;
      const double square = pass.error[at] * pass.error[at];
      (k < fitted ? all : all_held_out).add(square / pass.variance[at]);
      if (std::isnan(square) || settles[k]) continue;
      (k < fitted ? predicted : held_out).add(square);
      noise.add(pass.variance[at]);
    }
    errors.predicted.push_back(predicted.root()), errors.held_out.push_back(held_out.root());
    errors.noise.push_back(noise.root());
    portmanteaus.push_back(portmanteau_of(pass, j, fitted));
  }
  if (h.noise.is_of_simulation) {
    errors.mean_square = all.mean(), errors.held_out_mean_square = all_held_out.mean();
    use_simulation(fitter, h, errors);
    errors.portmanteau = std::ranges::max(portmanteaus);
    return errors;
  }
  errors.mean_square = all.mean(), errors.held_out_mean_square = all_held_out.mean();
  const size_t first = fitted < rows ? fitted : rows / criteria::settling_part,
               length = (rows - first) / criteria::simulations_of_any_diagram + 1;
  std::vector<MeanSquare> simulated(pass.outputs), expected(pass.outputs);
  std::vector<double> e, variance((rows - first) * pass.outputs);
  fitter.filter().expect_of_simulations(pass, settles, first, length, variance);
  for (size_t from = first; from < rows; from += length) {
    const size_t to = std::min(rows, from + length);
    e.resize((to - from) * pass.outputs);
    if (!fitter.filter().simulate(pass, settles, from, to, e)) errors.diverges = true;
    for (size_t i = 0; i < e.size(); ++i) {
      simulated[i % pass.outputs].add(e[i] * e[i]);
      if (std::isfinite(e[i])) expected[i % pass.outputs].add(variance[(from - first) * pass.outputs + i]);
    }
  }
  for (const MeanSquare& s : simulated) errors.simulated.push_back(s.root());
  for (const MeanSquare& s : expected) errors.expected_simulated.push_back(s.root());
  for (size_t j = 0; j < pass.outputs; ++j)
    if (!are_errors_of_counts(errors, record.outputs[j], j))
      errors.portmanteau = std::max(errors.portmanteau, portmanteaus[j]);
  return errors;
}

std::optional<size_t> missed_output(const SiteErrors& errors, const SiteNoise& noise, double times) {
  std::optional<size_t> worst;
  for (size_t j = 0; j < errors.simulated.size() && !errors.diverges; ++j)
    if (const double miss = errors.simulated[j] / noise.measurement[j]; miss > times) worst = j, times = miss;
  return worst;
}

double explained_by_noise(const SiteErrors& errors, const SiteNoise& noise, size_t output) {
  const double of_sensor = squared(noise.measurement[output]),
               of_states = std::max(0.0, squared(errors.expected_simulated[output]) - of_sensor);
  return std::sqrt(squared(criteria::notable_simulation) * of_sensor +
                   criteria::most_noise_of_simulations * of_states);
}

bool simulates_without(SiteFitter& fitter, const SiteHypothesis& found, const std::vector<bool>& optional,
                       const SiteErrors& with_all) {
  SiteHypothesis needed = found;
  for (size_t t = optional.size(); t-- > 0;)
    if (optional[t]) needed = without(std::move(needed), t);
  if (needed.terms.size() == found.terms.size() || with_all.diverges) return true;
  const SiteErrors errors = errors_of(fitter, needed);
  for (size_t j = 0; j < with_all.simulated.size(); ++j)
    if (errors.diverges ||
        errors.simulated[j] > criteria::worse_simulation_of_any_diagram * with_all.simulated[j])
      return false;
  return true;
}

bool simulates_worse(const SiteErrors& errors, const SiteErrors& nominal, bool holds_out) {
  if (errors.diverges || nominal.diverges) return errors.diverges;
  bool helps = !holds_out;
  for (size_t j = 0; j < errors.simulated.size(); ++j) {
    if (errors.simulated[j] > criteria::worse_simulation_of_any_diagram * nominal.simulated[j]) return true;
    helps |= errors.simulated[j] < nominal.simulated[j] || errors.held_out[j] < nominal.held_out[j];
  }
  return !helps;
}

bool is_exact(const SiteErrors& errors, const SignalRecord& record) {
  if (errors.diverges) return false;
  for (size_t j = 0; j < errors.simulated.size(); ++j) {
    double sum = 0, square = 0, count = 0;
    for (const double y : record.outputs[j].value)
      if (!std::isnan(y)) sum += y, square += y * y, ++count;
    const double spread = std::sqrt(std::max(0.0, square / count - sum * sum / (count * count)));
    if (!(errors.simulated[j] < criteria::error_of_arithmetic * spread)) return false;
  }
  return true;
}

}  // namespace loopwright::diagnosis
