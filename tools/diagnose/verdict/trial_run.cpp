#include "tools/diagnose/verdict/trial_run.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/compare/compare.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/verdict/improve.h"
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

double spread_of(const std::vector<double>& values) {
  double sum = 0, square = 0, count = 0;
  for (const double v : values)
    if (std::isfinite(v)) sum += v, square += v * v, ++count;
  return count > 0 ? std::sqrt(std::max(0.0, square / count - sum * sum / (count * count))) : 0;
}

/// A run that ends early counts as one that diverges.
bool is_complete(const Comparison& run, size_t rows) { return run.time.size() == rows; }

std::optional<std::string> why_diverges(const Comparison& improved, const Comparison& nominal) {
  for (size_t j = 0; j < improved.signals.size(); ++j) {
    const ComparedSignal &with = improved.signals[j], &without = nominal.signals[j];
    const double spread = spread_of(without.measured);
    // What is held by a controller runs away in a simulation of the plant by itself, whatever it lacks.
    if (!(without.rmse <= criteria::runaway_simulation * spread)) continue;
    const double most = std::max(criteria::diverging_simulation * without.rmse, spread);
    if (!(with.rmse <= most))
      return fmt::format("simulated along the record it misses {} by {}, the diagram as it is by {}",
                         without.name, shown(with.rmse, with.unit), shown(without.rmse, without.unit));
  }
  return {};
}

}  // namespace

std::optional<std::string> why_not_run(const Improvement& improved,
                                       const std::shared_ptr<const SourceFile>& nominal,
                                       const std::vector<std::shared_ptr<const Experiment>>& experiments,
                                       const LoadOptions& load) {
  if (improved.moved.empty() && improved.file->text == nominal->text) return {};
  for (const auto& experiment : experiments) {
    const size_t rows = experiment->data.columns.front().values.size();
    try {
      const Comparison before = compare_signals(nominal, *experiment, load);
      const Comparison after =
          compare_signals(improved.file, with_moved_ports(*experiment, improved.moved), load);
      if (!is_complete(before, rows)) continue;  // it tells nothing
      if (!is_complete(after, rows)) return after.run.message;
      if (const auto why = why_diverges(after, before)) return why;
    } catch (const InputError& error) {
      return error.problems.list().empty() ? error.what() : error.problems.list().front().message;
    }
  }
  return {};
}

bool is_usable(const Improvement& improved, const std::shared_ptr<const SourceFile>& nominal,
               const std::vector<std::shared_ptr<const Experiment>>& experiments, const LoadOptions& load,
               Diagnosis& result) {
  const auto why = why_not_run(improved, nominal, experiments, load);
  if (!why) return true;
  result.findings.push_back({"with what was found the diagram cannot be used: " + *why,
                             "no improved diagram is written", false, false});
  return false;
}

void write_improved(const Improvement& improved, const DiagnoseOptions& options, Diagnosis& result) {
  result.improved = options.improved_diagram;
  result.improved_experiments = write(improved, result.experiments, result.improved);
  result.experiment_ports = improved.moved, result.taken_out_by = improved.taken_out_by;
  result.improved_notes =
      notes_of(options.writes_all ? result.all_additions : result.additions, result.all_additions);
  std::ranges::copy(improved.left_out, std::back_inserter(result.improved_notes));
}

}  // namespace loopwright::diagnosis
