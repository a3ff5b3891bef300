#include "tools/fit/fit.h"
#include <array>
#include <ceres/ceres.h>
#include <glog/logging.h>
#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include "tools/fit/fit_model.h"

namespace loopwright {
namespace {

/// The errors in the form that Ceres needs; its unknowns are the parameters divided by their scales.
class Errors final : public ceres::CostFunction {
 public:
  Errors(FitModel& model, FitModel::Weights weights, int rows) : model_(model), weights_(std::move(weights)) {
    set_num_residuals(rows);
    mutable_parameter_block_sizes()->push_back(int(model.unknowns().size()));
  }
  bool Evaluate(const double* const* unknowns, double* residuals, double** jacobians) const override {
    std::vector<double> values;
    for (size_t i = 0; i < model_.unknowns().size(); ++i)
      values.push_back(unknowns[0][i] * scale_of(model_.unknowns()[i].number));
    const std::vector<double> errors = model_.errors(values, weights_);
    if (int(errors.size()) != num_residuals()) return false;
    std::ranges::copy(errors, residuals);
    if (!jacobians || !jacobians[0]) return true;
    const Eigen::MatrixXd columns = model_.jacobian(values, weights_, errors);
    if (columns.rows() == 0) return false;
    for (Eigen::Index k = 0; k < columns.rows(); ++k)
      for (Eigen::Index i = 0; i < columns.cols(); ++i)
        jacobians[0][k * columns.cols() + i] = columns(k, i) * scale_of(model_.unknowns()[size_t(i)].number);
    return true;
  }

 private:
  FitModel& model_;
  FitModel::Weights weights_;
};

class Watch final : public ceres::IterationCallback {
 public:
  Watch(const FitModel& model, const FitOptions& options, double rows)
      : model_(model), options_(options), rows_(rows) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (options_.progress) options_.progress(summary.iteration, std::sqrt(2 * summary.cost / rows_));
    return model_.is_interrupted() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const FitModel& model_;
  const FitOptions& options_;
  double rows_;
};

/// Levenberg-Marquardt from `values`; true when it converged.
bool improve(FitModel& model, const FitModel::Weights& weights, int rows, const FitOptions& options,
             std::vector<double>& values) {
  std::vector<double> unknowns;
  for (size_t i = 0; i < values.size(); ++i)
    unknowns.push_back(values[i] / scale_of(model.unknowns()[i].number));
  ceres::Problem problem;
  problem.AddResidualBlock(new Errors(model, weights, rows), nullptr,
                           unknowns.data());  // the problem owns it
  for (size_t i = 0; i < values.size(); ++i) {
    const DiagramNumber& number = model.unknowns()[i].number;
    if (std::isfinite(number.least))
      problem.SetParameterLowerBound(unknowns.data(), int(i), number.least / scale_of(number));
    if (std::isfinite(number.most))
      problem.SetParameterUpperBound(unknowns.data(), int(i), number.most / scale_of(number));
  }
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = options.most_iterations;
  settings.function_tolerance = 1e-8, settings.parameter_tolerance = 1e-7;
  settings.logging_type = ceres::SILENT;
  settings.num_threads = 1;
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres tells of an interruption although it is to be silent
  Watch watch(model, options, rows);
  settings.callbacks.push_back(&watch);
  settings.update_state_every_iteration = false;
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);
  for (size_t i = 0; i < values.size(); ++i) values[i] = unknowns[i] * scale_of(model.unknowns()[i].number);
  return summary.termination_type == ceres::CONVERGENCE;
}

/// How sure the parameters are.
struct Certainty {
  Eigen::MatrixXd covariance;
  double degrees_of_freedom;
  /// The half width of a two-sided interval of 95 % is this many standard deviations: Student's distribution.
  double width() const { return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975); }
};

/// Covariance from the scatter of gradients between blocks of the records, because errors of adjacent rows
/// are correlated. Each parameter takes a degree of freedom from the blocks: there are at least twice as
/// many.
Certainty certainty(const Eigen::MatrixXd& j, const std::vector<double>& errors,
                    const std::vector<size_t>& row_of) {
  constexpr size_t rows_a_block = 50, most_blocks = 24;
  const Eigen::Index p = j.cols();
  const size_t rows = 1 + *std::ranges::max_element(row_of), least_blocks = 2 * size_t(p) + 2;
  const size_t blocks = std::clamp(rows / rows_a_block, least_blocks, std::max(least_blocks, most_blocks));
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(Eigen::Index(blocks), p);
  for (size_t k = 0; k < errors.size(); ++k)
    scores.row(Eigen::Index(row_of[k] * blocks / rows)) += errors[k] * j.row(Eigen::Index(k));
  const Eigen::MatrixXd inverse = (j.transpose() * j).completeOrthogonalDecomposition().pseudoInverse();
  const double degrees_of_freedom = double(blocks) - double(p);
  return {double(blocks) / degrees_of_freedom * inverse * (scores.transpose() * scores) * inverse,
          degrees_of_freedom};
}

/// Names what the record does not determine: parameters without effect, and combinations.
void warn_of_what_is_open(const Eigen::MatrixXd& j, const std::vector<FittedParameter*>& parameters,
                          std::vector<std::string>& warnings) {
  const Eigen::Index p = j.cols();
  Eigen::MatrixXd columns = j;
  double largest = 0;
  for (Eigen::Index i = 0; i < p; ++i)
    largest = std::max(largest, j.col(i).norm() * scale_of({parameters[size_t(i)]->value}));
  for (Eigen::Index i = 0; i < p; ++i) {
    const double norm = j.col(i).norm();
    if (norm * scale_of({parameters[size_t(i)]->value}) <= 1e-9 * largest) {
      parameters[size_t(i)]->is_determined = false;
      warnings.push_back(fmt::format("the record does not depend on \"{}\"", parameters[size_t(i)]->path));
    }
    columns.col(i) /= std::max(norm, 1e-300);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns.transpose() * columns, Eigen::ComputeFullV);
  for (Eigen::Index i = 0; i < p; ++i) {
    if (svd.singularValues()(i) > 1e-4) continue;
    std::string names;
    int count = 0;
    for (Eigen::Index n = 0; n < p; ++n) {
      if (std::abs(svd.matrixV()(n, i)) < 0.2 || !parameters[size_t(n)]->is_determined) continue;
      names += fmt::format("{}\"{}\"", count++ ? ", " : "", parameters[size_t(n)]->path);
      parameters[size_t(n)]->is_determined = false;
    }
    if (count > 1)
      warnings.push_back(
          fmt::format("this record cannot tell {} apart: only a combination of them is determined", names));
  }
}

double rms(const std::vector<double>& values, size_t begin, size_t end) {
  double sum = 0;
  for (size_t k = begin; k < end; ++k) sum += values[k] * values[k];
  return end > begin ? std::sqrt(sum / double(end - begin)) : 0;
}

/// The best values of some rounds, each with the weights that the errors before it call for.
struct Best {
  std::vector<double> values;
  double profile;
  std::vector<Comparison> runs;
};

bool fit_in_rounds(FitModel& model, const FitOptions& options, Best& best) {
  constexpr int rounds = 2;
  bool has_converged = false;
  std::vector<double> values = best.values;
  std::vector<Comparison> runs = best.runs;
  for (int round = 0; round < rounds && !model.is_interrupted(); ++round) {
    const FitModel::Weights weights = model.weights_of(runs);
    const size_t rows = model.errors(values, weights).size();
    if (rows == 0) break;
    const bool converges = improve(model, weights, int(rows), options, values);
    runs = model.simulate(values);
    if (model.is_interrupted()) break;  // these runs are incomplete
    const double profile = model.profile(runs);
    if (!(profile <= best.profile)) break;
    best = {values, profile, runs}, has_converged = converges;
  }
  return has_converged;
}

std::vector<FittedSignal> signals_of(const FitModel::Record& record, const Comparison& before,
                                     const Comparison& after) {
  std::vector<FittedSignal> list;
  for (size_t s = 0; s < after.signals.size(); ++s) {
    const ComparedSignal &a = before.signals[s], &b = after.signals[s];
    const size_t fitted = record.fitted_rows(b.error.size()), all = b.error.size();
    list.push_back({b.name, b.unit, rms(a.error, 0, fitted), rms(b.error, 0, fitted),
                    rms(a.error, std::min(fitted, a.error.size()), a.error.size()),
                    rms(b.error, fitted, all)});
  }
  return list;
}

/// Of each port over all records.
std::vector<FittedSignal> pooled(const FitModel& model, const std::vector<FittedRecord>& records,
                                 const std::vector<Comparison>& runs) {
  std::vector<FittedSignal> list;
  std::vector<std::array<double, 2>> rows;  // fitted, held out
  for (size_t r = 0; r < records.size(); ++r)
    for (size_t s = 0; s < records[r].signals.size(); ++s) {
      const FittedSignal& own = records[r].signals[s];
      auto of_port = std::ranges::find(list, own.name, &FittedSignal::name);
      if (of_port == list.end()) of_port = list.insert(of_port, {own.name, own.unit}), rows.push_back({0, 0});
      std::array<double, 2>& n = rows[size_t(of_port - list.begin())];
      const size_t all = runs[r].signals[s].error.size(), fitted = model.records()[r].fitted_rows(all);
      const double own_rows[] = {double(fitted), double(all - fitted)};
      for (const auto& [side, of] : {std::pair(0, &FittedSignal::before),
                                     {0, &FittedSignal::after},
                                     {1, &FittedSignal::held_out_before},
                                     {1, &FittedSignal::held_out_after}}) {
        const double sum =
            n[size_t(side)] * (*of_port).*of * (*of_port).*of + own_rows[side] * own.*of * own.*of;
        const double count = n[size_t(side)] + own_rows[side];
        (*of_port).*of = count > 0 ? std::sqrt(sum / count) : 0;
      }
      n[0] += own_rows[0], n[1] += own_rows[1];
    }
  return list;
}

FitCorrelations correlations_of(const Eigen::MatrixXd& c, const std::vector<FittedParameter*>& parameters) {
  FitCorrelations result;
  for (const FittedParameter* parameter : parameters) result.names.push_back(parameter->path);
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    auto& row = result.of_each.emplace_back();
    for (Eigen::Index k = 0; k < c.cols(); ++k) {
      const double size = std::sqrt(c(i, i) * c(k, k));
      row.push_back(i == k ? 1 : size > 0 ? std::clamp(c(i, k) / size, -1.0, 1.0) : 0);
    }
  }
  return result;
}

void add_intervals(FitModel& model, const Best& best, const std::vector<FittedParameter*>& parameters,
                   Fit& result) {
  const FitModel::Weights weights = model.weights_of(best.runs);
  const std::vector<double> errors = model.errors(best.values, weights);
  if (errors.empty()) return;
  const Eigen::MatrixXd j = model.jacobian(best.values, weights, errors);
  if (j.rows() == 0) return;
  warn_of_what_is_open(j, parameters, result.warnings);
  const Certainty sure = certainty(j, errors, model.rows_of_errors());
  const Eigen::MatrixXd& c = sure.covariance;
  result.correlations = correlations_of(c, parameters);
  for (size_t i = 0; i < parameters.size(); ++i) {
    const double half = sure.width() * std::sqrt(std::max(0.0, c(Eigen::Index(i), Eigen::Index(i))));
    parameters[i]->low -= half, parameters[i]->high += half;
  }
}

/// Nearer to zero than the step of its derivative no difference is known of a parameter that must not change
/// its sign: without any stiffness the diagram need not run.
void warn_of_limits(const std::vector<FittedParameter*>& parameters, std::vector<std::string>& warnings) {
  constexpr double rounding = 1e-4;  // of a step, by which the last one may be beside it
  for (const FittedParameter* p : parameters) {
    const double step = (1 + rounding) * derivative_step(p->start, p->value),
                 near = 1e-6 * std::abs(p->start);
    const auto reach = [&](double limit) { return limit == 0 ? step : near; };
    if (p->value <= p->least + reach(p->least) || p->value >= p->most - reach(p->most))
      warnings.push_back(fmt::format(
          "\"{}\" ends at the limit of what its block, its sign at the start or its range allows, or "
          "a hundredth of its start away from zero",
          p->path));
  }
}

}  // namespace

bool Fit::is_as_at_start() const {
  return std::ranges::all_of(parameters, [](const FittedParameter& p) { return p.value == p.start; });
}

Fit fit(const std::string& diagram, const std::vector<std::string>& experiments,
        const std::vector<std::string>& parameters, const LoadOptions& options,
        const FitOptions& fit_options) {
  FitModel model(diagram, experiments, parameters, options, fit_options);
  Best best{model.start(), 0, {}};
  const std::vector<Comparison> before = best.runs = model.simulate(best.values);
  for (const Comparison& c : before)
    if (c.run.status == RunStatus::interrupted) {
      Fit nothing;
      nothing.was_interrupted = true;
      return nothing;
    } else if (c.run.status != RunStatus::finished) {
      throw std::runtime_error("the diagram does not run with its present parameters: " + c.run.message);
    }
  best.profile = model.profile(before);
  const double at_start = best.profile;

  Fit result;
  result.has_converged = fit_in_rounds(model, fit_options, best);
  result.was_interrupted = model.is_interrupted();
  if (result.was_interrupted) {
    result.has_converged = false;
    result.warnings.push_back(
        "interrupted: the values are those of the last round that was finished, without intervals");
  } else if (best.profile >= at_start && best.values == model.start() && !result.has_converged) {
    result.warnings.push_back("no better values were found: the parameters stay as they were");
  }
  for (size_t r = 0; r < model.records().size(); ++r) {
    const FitModel::Record& record = model.records()[r];
    result.records.push_back({record.experiment->path,
                              record.is_held_out || record.experiment->hold_out_fraction >= 1,
                              {},
                              signals_of(record, before[r], best.runs[r])});
  }
  result.signals = pooled(model, result.records, best.runs);
  for (size_t i = 0; i < best.values.size(); ++i) {
    const Unknown& unknown = model.unknowns()[i];
    const DiagramNumber& n = unknown.number;
    const double value = best.values[i];
    auto& list =
        unknown.record == Unknown::shared ? result.parameters : result.records[unknown.record].parameters;
    list.push_back(
        {unknown.path, n.unit ? to_string(*n.unit) : "", n.value, value, value, value, n.least, n.most});
  }
  std::vector<FittedParameter*> all;  // in the order of the unknowns: what is shared is first
  for (FittedParameter& p : result.parameters) all.push_back(&p);
  for (const std::string& path : fit_options.of_each)
    for (FittedRecord& record : result.records)
      for (FittedParameter& p : record.parameters)
        if (p.path == path) all.push_back(&p);
  if (!result.was_interrupted)
    add_intervals(model, best, all, result);
  else
    for (FittedParameter* p : all) p->low = p->high = std::numeric_limits<double>::quiet_NaN();
  warn_of_limits(all, result.warnings);
  for (const Comparison& c : before)
    if (const int64_t missing = c.missing_samples; missing > 0)
      result.warnings.push_back(
          fmt::format("{} sample{} between the rows of the recording {} missing: held inputs "
                      "were held there",
                      missing, missing == 1 ? "" : "s", missing == 1 ? "is" : "are"));
  result.before = before, result.after = std::move(best.runs);
  result.simulations = model.simulations();
  return result;
}

}  // namespace loopwright
