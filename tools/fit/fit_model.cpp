#include "tools/fit/fit_model.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>
#include "engine/json/reader.h"
#include "models/real/whole.h"
#include "tools/experiment/balances.h"
#include "tools/experiment/experiment_ports.h"
#include "tools/experiment/repeated_records.h"

namespace loopwright {
namespace {

void take_offset_out(ComparedSignal& signal, size_t fitted) {
  const size_t rows = fitted > 0 ? fitted : signal.error.size();
  double mean = 0;
  for (size_t k = 0; k < rows; ++k) mean += signal.error[k] / double(rows);
  for (double& e : signal.error) e -= mean;
}

}  // namespace

double derivative_step(double start, double value) {
  const double size = std::max(std::abs(value), std::abs(start));
  return size > 0 ? 1e-2 * size : 1e-2;
}

double scale_of(const DiagramNumber& number) { return number.value != 0 ? std::abs(number.value) : 1.0; }

size_t FitModel::Record::fitted_rows(size_t rows) const {
  if (is_held_out) return 0;
  return rows - whole_between<size_t>(double(rows) * experiment->hold_out_fraction, 0, rows);
}

FitModel::FitModel(const std::string& diagram, const std::vector<std::string>& experiments,
                   const std::vector<std::string>& parameters, const LoadOptions& options,
                   const FitOptions& fit_options)
    : diagram_(diagram), options_(options), fit_options_(fit_options) {
  Problems problems;
  run_options_.interrupt = fit_options.interrupt;
  std::vector<std::shared_ptr<const Experiment>> loaded;
  for (const auto* list : {&experiments, &fit_options.held_out})
    for (const std::string& path : *list) {
      const auto experiment = load_experiment(path, problems);
      if (experiment) reject_map(*experiment, problems);
      records_.push_back({path, experiment, list == &fit_options.held_out});
      loaded.push_back(experiment);
    }
  refuse_repeated_records(loaded, problems);
  if (parameters.empty() && fit_options.of_each.empty())
    problems.error({}, "", "", "no parameters are named").expected = "--parameters mass,damping";
  find_unknowns(parameters, problems);
  const bool fits_nothing = std::ranges::all_of(records_, [](const Record& record) {
    return record.is_held_out || !record.experiment || record.experiment->hold_out_fraction >= 1;
  });
  if (fits_nothing && !problems.has_errors())
    problems.error({}, "", "", "every record is held out").expected = "a record to fit";
  if (problems.has_errors()) explain_failure(diagram, paths(), options, std::move(problems));
}

void FitModel::find_unknowns(const std::vector<std::string>& parameters, Problems& problems) {
  Problems of_diagram;  // reported with those of the experiments
  const auto loaded = load_diagram(diagram_, options_, of_diagram);
  if (!loaded) return;
  std::set<std::string> named;
  for (const std::vector<std::string>* list : {&parameters, &std::as_const(fit_options_.of_each)})
    for (const std::string& path : *list)
      if (!named.insert(path).second)
        problems.error({}, "", "", fmt::format("\"{}\" is to be fitted twice", path)).expected =
            "each parameter once, in --parameters or in --of-each";
      else if (const auto number = find_number(*loaded, path, problems)) {
        refuse_known(path, problems);
        Unknown unknown{path, *number};
        bound(unknown, problems);
        if (list == &parameters) {
          unknowns_.push_back(unknown);
          continue;
        }
        for (unknown.record = 0; unknown.record < records_.size(); ++unknown.record)
          if (!records_[unknown.record].is_held_out) unknowns_.push_back(unknown);
      }
  for (const ParameterRange& range : fit_options_.ranges) {
    const bool is_fitted =
        std::ranges::any_of(unknowns_, [&](const Unknown& u) { return u.path == range.path; });
    if (is_fitted || problems.has_errors()) continue;
    KnownNames names;
    for (const Unknown& unknown : unknowns_) names.add(unknown.path);
    names.explain(
        problems.error({}, "", "", fmt::format("--range names \"{}\", which is not fitted", range.path)),
        range.path);
  }
}

/// What a record states for itself is known there, and has no value in common.
void FitModel::refuse_known(const std::string& path, Problems& problems) const {
  const auto leads_to = [](const std::string& a, const std::string& b) {
    return b.starts_with(a) && (b.size() == a.size() || b[a.size()] == '.');
  };
  for (const Record& record : records_) {
    if (!record.experiment) continue;
    for (const Value::Member& setting : record.experiment->set) {
      if (!leads_to(setting.name, path) && !leads_to(path, setting.name)) continue;
      auto& p = problems.error(setting.place, setting.value.place.pointer(), "",
                               fmt::format("\"{}\" is to be fitted, and this record sets it", path));
      p.expected = "either in \"set\", as known, or among the fitted parameters";
      p.hint =
          "where only a part is known, make that a parameter of the diagram, \"=carriage + payload\", or the "
          "\"payload\" of a Mass: set that, and fit the rest";
    }
  }
}

/// A parameter keeps its sign, unless a range says what it may be.
void FitModel::bound(Unknown& unknown, Problems& problems) const {
  DiagramNumber& number = unknown.number;
  const auto range = std::ranges::find(fit_options_.ranges, unknown.path, &ParameterRange::path);
  if (range == fit_options_.ranges.end()) {
    // A state or an offset of a record may have any sign.
    const bool keeps_sign =
        std::ranges::find(fit_options_.of_each, unknown.path) == fit_options_.of_each.end();
    if (keeps_sign && number.value > 0) number.least = std::max(number.least, 0.0);
    if (keeps_sign && number.value < 0) number.most = std::min(number.most, 0.0);
    return;
  }
  number.least = std::max(number.least, range->low), number.most = std::min(number.most, range->high);
  if (number.least < number.most && number.value >= number.least && number.value <= number.most) return;
  auto& p = problems.error({}, "", "", fmt::format("\"{}\" begins outside of its range", unknown.path));
  p.expected = fmt::format("a value from {:.6g} to {:.6g}", number.least, number.most);
  p.found = fmt::format("{:.6g}", number.value);
  p.hint = fmt::format("give another start with --set {}=…", unknown.path);
}

std::vector<double> FitModel::start() const {
  std::vector<double> values;
  for (const Unknown& unknown : unknowns_) values.push_back(unknown.number.value);
  return values;
}

Comparison FitModel::simulate(size_t record, const std::vector<double>& values) {
  LoadOptions options = options_;
  for (size_t i = 0; i < values.size(); ++i)
    if (unknowns_[i].record == Unknown::shared || unknowns_[i].record == record)
      options.set.push_back(setting(unknowns_[i].path, unknowns_[i].number, values[i]));
  ++simulations_;
  Comparison c = compare_signals(diagram_, *records_[record].experiment, options, run_options_);
  if (fit_options_.takes_offsets_out)
    for (ComparedSignal& s : c.signals) take_offset_out(s, records_[record].fitted_rows(s.error.size()));
  return c;
}

std::vector<Comparison> FitModel::simulate(const std::vector<double>& values) {
  std::vector<Comparison> all;
  try {
    for (size_t r = 0; r < records_.size(); ++r) all.push_back(simulate(r, values));
  } catch (InputError& error) {
    explain_failure(diagram_, paths(), options_, std::move(error.problems));
  }
  return all;
}

std::vector<std::string> FitModel::paths() const {
  std::vector<std::string> list;
  for (const Record& record : records_) list.push_back(record.path);
  return list;
}

std::map<std::string, FitModel::Squares> FitModel::squares_of(const std::vector<Comparison>& all) const {
  std::map<std::string, Squares> ports;
  for (size_t r = 0; r < all.size(); ++r)
    for (const ComparedSignal& s : all[r].signals) {
      const size_t rows = records_[r].fitted_rows(s.error.size());
      if (rows == 0) continue;
      Squares& port = ports[s.name];
      port.rows += double(rows), port.resolution = std::max(port.resolution, s.resolution);
      for (size_t k = 0; k < rows; ++k)
        port.sum += s.error[k] * s.error[k], port.size += s.measured[k] * s.measured[k];
    }
  return ports;
}

FitModel::Weights FitModel::weights_of(const std::vector<Comparison>& all) const {
  Weights weights;
  for (const auto& [name, port] : squares_of(all)) {
    const double least = std::max({port.resolution, 1e-9 * std::sqrt(port.size / port.rows), 1e-300});
    weights[name] = 1 / std::max(std::sqrt(port.sum / port.rows), least);
  }
  return weights;
}

double FitModel::profile(const std::vector<Comparison>& all) const {
  double sum = 0;
  for (const Comparison& c : all)
    if (c.run.status != RunStatus::finished) return infinity;
  for (const auto& [name, port] : squares_of(all))
    sum += port.rows * std::log(std::max(port.sum / port.rows, 1e-300));
  return std::isfinite(sum) ? sum : infinity;
}

std::vector<double> FitModel::errors(size_t record, const std::vector<double>& values,
                                     const Weights& weights) {
  std::vector<double> errors;
  if (records_[record].is_held_out) return errors;
  try {
    const Comparison c = simulate(record, values);
    if (c.run.status != RunStatus::finished) return {};
    for (const ComparedSignal& s : c.signals) {
      const size_t rows = records_[record].fitted_rows(s.error.size());
      if (rows == 0) continue;
      const double weight = weights.at(s.name);
      for (size_t k = 0; k < rows; ++k) errors.push_back(weight * s.error[k]);
    }
  } catch (const InputError&) {
    return {};
  }
  return errors;
}

std::vector<double> FitModel::errors(const std::vector<double>& values, const Weights& weights) {
  std::vector<double> all;
  size_t before = 0;
  rows_of_errors_.clear(), errors_of_record_.assign(records_.size(), 0);
  for (size_t r = 0; r < records_.size(); ++r) {
    if (records_[r].is_held_out || records_[r].experiment->hold_out_fraction >= 1) continue;
    const std::vector<double> own = errors(r, values, weights);
    if (own.empty()) return {};
    all.insert(all.end(), own.begin(), own.end());
    errors_of_record_[r] = own.size();
    const size_t rows = records_[r].experiment->data.rows(), fitted = records_[r].fitted_rows(rows);
    for (const RecordedSignal& signal : records_[r].experiment->compared) {
      const auto& [first, every] = signal.rows;
      const size_t readings = (rows - first + every - 1) / every;
      for (size_t k = 0; k < records_[r].fitted_rows(readings); ++k)
        rows_of_errors_.push_back(before + std::min(first + k * every, fitted - 1));
    }
    before += fitted;
  }
  return all;
}

Eigen::MatrixXd FitModel::jacobian(const std::vector<double>& values, const Weights& weights,
                                   const std::vector<double>& at) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(Eigen::Index(at.size()), Eigen::Index(values.size()));
  for (size_t i = 0; i < values.size(); ++i) {
    const DiagramNumber& number = unknowns_[i].number;
    const double step = derivative_step(number.value, values[i]);
    std::vector<double> up = values, down = values;
    up[i] = std::min(values[i] + step, number.most), down[i] = std::max(values[i] - step, number.least);
    Eigen::Index row = 0;
    for (size_t r = 0; r < records_.size(); ++r) {
      const bool matters = unknowns_[i].record == Unknown::shared || unknowns_[i].record == r;
      if (errors_of_record_[r] == 0 || !matters) {
        row += Eigen::Index(errors_of_record_[r]);
        continue;
      }
      const std::vector<double> above = errors(r, up, weights), below = errors(r, down, weights);
      if (above.size() != errors_of_record_[r] || below.size() != errors_of_record_[r]) return {};
      for (size_t k = 0; k < above.size(); ++k)
        result(row++, Eigen::Index(i)) = (above[k] - below[k]) / (up[i] - down[i]);
    }
  }
  return result;
}

}  // namespace loopwright
