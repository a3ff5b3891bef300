#include "tools/fit/fit.h"
#include <ceres/ceres.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "tools/experiment/experiment_ports.h"
#include "tools/fit/parameter.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// Simulations of one diagram along one experiment, with the parameters at given values.
class Model {
 public:
  Model(std::string diagram, std::shared_ptr<const Experiment> experiment,
        const std::vector<std::string>& paths, const LoadOptions& options, const FitOptions& fit_options)
      : diagram_(std::move(diagram)),
        experiment_(std::move(experiment)),
        options_(options),
        fit_options_(fit_options) {
    Problems problems;
    const auto loaded = load_diagram(diagram_, options_, problems);
    if (loaded)
      for (const std::string& path : paths)
        if (const auto number = find_number(*loaded, path, problems))
          paths_.push_back(path), numbers_.push_back(*number);
    if (problems.has_errors()) throw InputError(std::move(problems));
    run_options_.interrupt = fit_options.interrupt;
  }

  const std::vector<DiagramNumber>& numbers() const { return numbers_; }
  int simulations() const { return simulations_; }
  bool is_interrupted() const { return fit_options_.interrupt && *fit_options_.interrupt; }

  std::vector<double> start() const {
    std::vector<double> values;
    for (const DiagramNumber& number : numbers_) values.push_back(number.value);
    return values;
  }

  /// Throws InputError when the blocks reject the values.
  Comparison simulate(const std::vector<double>& values) {
    LoadOptions options = options_;
    for (size_t i = 0; i < values.size(); ++i)
      options.set.push_back(setting(paths_[i], numbers_[i], values[i]));
    ++simulations_;
    return compare_signals(diagram_, *experiment_, options, run_options_);
  }

  size_t fitted_rows(const ComparedSignal& signal) const {
    return signal.measured.size() -
           whole_between<size_t>(double(signal.measured.size()) * experiment_->hold_out_fraction, 0,
                                 signal.measured.size());
  }
  size_t rows() const { return experiment_->data.rows(); }

  /// Weighted errors of the fitted rows, signal after signal; empty when the run does not reach its end.
  std::vector<double> errors(const std::vector<double>& values, const std::vector<double>& weights) {
    std::vector<double> all;
    try {
      const Comparison c = simulate(values);
      if (c.run.status != RunStatus::finished) return {};
      for (size_t s = 0; s < c.signals.size(); ++s)
        for (size_t k = 0; k < fitted_rows(c.signals[s]); ++k)
          all.push_back(weights[s] * c.signals[s].error[k]);
    } catch (const InputError&) {
      return {};
    }
    return all;
  }

 private:
  std::string diagram_;
  std::shared_ptr<const Experiment> experiment_;
  LoadOptions options_;
  RunOptions run_options_;
  FitOptions fit_options_;
  std::vector<std::string> paths_;
  std::vector<DiagramNumber> numbers_;
  int simulations_ = 0;
};

/// Large steps: where friction sticks and releases, errors jump from step to step, and small differences
/// measure only these jumps.
double step_of(const DiagramNumber& number, double value) {
  const double size = std::max(std::abs(value), std::abs(number.value));
  return size > 0 ? 1e-2 * size : 1e-2;
}

double scale_of(const DiagramNumber& number) { return number.value != 0 ? std::abs(number.value) : 1.0; }

/// Columns of derivatives of the errors, by central differences; empty after a failed run.
Eigen::MatrixXd jacobian(Model& model, const std::vector<double>& values, const std::vector<double>& weights,
                         const std::vector<double>& errors) {
  Eigen::MatrixXd result(Eigen::Index(errors.size()), Eigen::Index(values.size()));
  for (size_t i = 0; i < values.size(); ++i) {
    const DiagramNumber& number = model.numbers()[i];
    const double step = step_of(number, values[i]);
    std::vector<double> up = values, down = values;
    up[i] = std::min(values[i] + step, number.most), down[i] = std::max(values[i] - step, number.least);
    const std::vector<double> above = model.errors(up, weights), below = model.errors(down, weights);
    if (above.size() != errors.size() || below.size() != errors.size()) return {};
    for (size_t k = 0; k < errors.size(); ++k)
      result(Eigen::Index(k), Eigen::Index(i)) = (above[k] - below[k]) / (up[i] - down[i]);
  }
  return result;
}

/// The errors in the form that Ceres needs; its unknowns are the parameters divided by their scales.
class Errors final : public ceres::CostFunction {
 public:
  Errors(Model& model, std::vector<double> weights, int rows) : model_(model), weights_(std::move(weights)) {
    set_num_residuals(rows);
    mutable_parameter_block_sizes()->push_back(int(model.numbers().size()));
  }
  bool Evaluate(const double* const* unknowns, double* residuals, double** jacobians) const override {
    std::vector<double> values;
    for (size_t i = 0; i < model_.numbers().size(); ++i)
      values.push_back(unknowns[0][i] * scale_of(model_.numbers()[i]));
    const std::vector<double> errors = model_.errors(values, weights_);
    if (int(errors.size()) != num_residuals()) return false;
    std::ranges::copy(errors, residuals);
    if (!jacobians || !jacobians[0]) return true;
    const Eigen::MatrixXd columns = jacobian(model_, values, weights_, errors);
    if (columns.rows() == 0) return false;
    for (Eigen::Index k = 0; k < columns.rows(); ++k)
      for (Eigen::Index i = 0; i < columns.cols(); ++i)
        jacobians[0][k * columns.cols() + i] = columns(k, i) * scale_of(model_.numbers()[size_t(i)]);
    return true;
  }

 private:
  Model& model_;
  std::vector<double> weights_;
};

class Watch final : public ceres::IterationCallback {
 public:
  Watch(const Model& model, const FitOptions& options, double rows)
      : model_(model), options_(options), rows_(rows) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (options_.progress) options_.progress(summary.iteration, std::sqrt(2 * summary.cost / rows_));
    return model_.is_interrupted() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const Model& model_;
  const FitOptions& options_;
  double rows_;
};

/// Levenberg-Marquardt from `values`; true when it converged.
bool improve(Model& model, const std::vector<double>& weights, int rows, const FitOptions& options,
             std::vector<double>& values) {
  std::vector<double> unknowns;
  for (size_t i = 0; i < values.size(); ++i) unknowns.push_back(values[i] / scale_of(model.numbers()[i]));
  ceres::Problem problem;
  problem.AddResidualBlock(new Errors(model, weights, rows), nullptr,
                           unknowns.data());  // the problem owns it
  for (size_t i = 0; i < values.size(); ++i) {
    const DiagramNumber& number = model.numbers()[i];
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
  Watch watch(model, options, rows);
  settings.callbacks.push_back(&watch);
  settings.update_state_every_iteration = false;
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);
  for (size_t i = 0; i < values.size(); ++i) values[i] = unknowns[i] * scale_of(model.numbers()[i]);
  return summary.termination_type == ceres::CONVERGENCE;
}

std::vector<double> weights_of(const Model& model, const Comparison& c) {
  std::vector<double> weights;
  for (const ComparedSignal& s : c.signals) {
    double sum = 0, size = 0;
    const size_t rows = model.fitted_rows(s);
    for (size_t k = 0; k < rows; ++k) sum += s.error[k] * s.error[k], size += s.measured[k] * s.measured[k];
    const double least = std::max({s.resolution, 1e-9 * std::sqrt(size / double(rows)), 1e-300});
    weights.push_back(1 / std::max(std::sqrt(sum / double(rows)), least));
  }
  return weights;
}

/// Covariance from the scatter of gradients between blocks of the record, because errors of adjacent rows are
/// correlated.
Eigen::MatrixXd covariance(const Eigen::MatrixXd& j, const std::vector<double>& errors,
                           size_t rows_of_signal) {
  const Eigen::Index p = j.cols();
  const size_t blocks = std::min<size_t>(24, std::max<size_t>(size_t(p) + 2, rows_of_signal / 50));
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(Eigen::Index(blocks), p);
  for (size_t k = 0; k < errors.size(); ++k) {
    const size_t block = (k % rows_of_signal) * blocks / rows_of_signal;
    scores.row(Eigen::Index(block)) += errors[k] * j.row(Eigen::Index(k));
  }
  const Eigen::MatrixXd inverse = (j.transpose() * j).completeOrthogonalDecomposition().pseudoInverse();
  const double correction = double(blocks) / std::max(1.0, double(blocks) - double(p));
  return correction * inverse * (scores.transpose() * scores) * inverse;
}

/// Names what the record does not determine: parameters without effect, and combinations.
void warn_of_what_is_open(const Eigen::MatrixXd& j, const std::vector<std::string>& paths, Fit& fit) {
  const Eigen::Index p = j.cols();
  Eigen::MatrixXd columns = j;
  double largest = 0;
  for (Eigen::Index i = 0; i < p; ++i)
    largest = std::max(largest, j.col(i).norm() * scale_of({fit.parameters[size_t(i)].value}));
  for (Eigen::Index i = 0; i < p; ++i) {
    const double norm = j.col(i).norm();
    if (norm * scale_of({fit.parameters[size_t(i)].value}) <= 1e-9 * largest) {
      fit.parameters[size_t(i)].is_determined = false;
      fit.warnings.push_back(fmt::format("the record does not depend on \"{}\"", paths[size_t(i)]));
    }
    columns.col(i) /= std::max(norm, 1e-300);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns.transpose() * columns, Eigen::ComputeFullV);
  for (Eigen::Index i = 0; i < p; ++i) {
    if (svd.singularValues()(i) > 1e-4) continue;
    std::string names;
    int count = 0;
    for (Eigen::Index n = 0; n < p; ++n) {
      if (std::abs(svd.matrixV()(n, i)) < 0.2 || !fit.parameters[size_t(n)].is_determined) continue;
      names += fmt::format("{}\"{}\"", count++ ? ", " : "", paths[size_t(n)]);
      fit.parameters[size_t(n)].is_determined = false;
    }
    if (count > 1)
      fit.warnings.push_back(
          fmt::format("this record cannot tell {} apart: only a combination of them is determined", names));
  }
}

double rms(const std::vector<double>& values, size_t begin, size_t end) {
  double sum = 0;
  for (size_t k = begin; k < end; ++k) sum += values[k] * values[k];
  return end > begin ? std::sqrt(sum / double(end - begin)) : 0;
}

void check_parameters(const std::string& diagram, const std::vector<std::string>& paths,
                      const LoadOptions& options, Problems& problems) {
  Problems of_diagram;  // reported with those of the experiment
  if (const auto loaded = load_diagram(diagram, options, of_diagram))
    for (const std::string& path : paths) find_number(*loaded, path, problems);
}

}  // namespace

Fit fit(const std::string& diagram, const std::string& experiment_path, const std::vector<std::string>& paths,
        const LoadOptions& options, const FitOptions& fit_options) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  if (experiment) reject_map(*experiment, problems);
  if (paths.empty())
    problems.error({}, "", "", "no parameters are named").expected = "--parameters mass,damping";
  check_parameters(diagram, paths, options, problems);
  if (!experiment || problems.has_errors())
    explain_failure(diagram, {experiment_path}, options, std::move(problems));
  Model model(diagram, experiment, paths, options, fit_options);
  std::vector<double> values = model.start();
  const Comparison before = model.simulate(values);
  if (before.run.status != RunStatus::finished)
    throw std::runtime_error("the diagram does not run with its present parameters: " + before.run.message);
  int rows = 0;
  for (const ComparedSignal& s : before.signals) rows += int(model.fitted_rows(s));

  Fit result;
  std::vector<double> weights = weights_of(model, before);
  for (int round = 0; round < 2 && !model.is_interrupted(); ++round) {
    result.has_converged = improve(model, weights, rows, fit_options, values);
    weights = weights_of(model, model.simulate(values));
  }
  result.was_interrupted = model.is_interrupted();
  const Comparison after = model.simulate(values);
  for (size_t s = 0; s < after.signals.size(); ++s) {
    const ComparedSignal &a = before.signals[s], &b = after.signals[s];
    const size_t fitted = model.fitted_rows(b), all = b.error.size();
    result.signals.push_back({b.name, b.unit, rms(a.error, 0, fitted), rms(b.error, 0, fitted),
                              rms(a.error, fitted, all), rms(b.error, fitted, all)});
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const DiagramNumber& n = model.numbers()[i];
    result.parameters.push_back({paths[i], n.unit ? to_string(*n.unit) : "", n.value, values[i], values[i],
                                 values[i], n.least, n.most});
  }
  const std::vector<double> errors = model.errors(values, weights);
  const Eigen::MatrixXd j =
      result.was_interrupted ? Eigen::MatrixXd() : jacobian(model, values, weights, errors);
  if (j.rows() > 0) {
    warn_of_what_is_open(j, paths, result);
    const Eigen::MatrixXd c = covariance(j, errors, model.fitted_rows(after.signals.front()));
    constexpr double t = 2.07;  // two-sided 95 % of Student's distribution with some 22 degrees of freedom
    for (size_t i = 0; i < values.size(); ++i) {
      const double half = t * std::sqrt(std::max(0.0, c(Eigen::Index(i), Eigen::Index(i))));
      result.parameters[i].low -= half, result.parameters[i].high += half;
    }
  }
  for (const FittedParameter& p : result.parameters)
    if (const double near = 1e-6 * std::abs(p.start); p.value <= p.least + near || p.value >= p.most - near)
      result.warnings.push_back(fmt::format("\"{}\" ends at the limit of what its block allows", p.path));
  if (const int64_t missing = before.missing_samples; missing > 0)
    result.warnings.push_back(
        fmt::format("{} sample{} between the rows of the recording {} missing: held inputs "
                    "were held there",
                    missing, missing == 1 ? "" : "s", missing == 1 ? "is" : "are"));
  result.simulations = model.simulations();
  return result;
}

}  // namespace loopwright
