/// The errors of a diagram along several records, as a function of the unknowns of a fit.
#pragma once
#include <Eigen/Dense>
#include <map>
#include "tools/fit/fit.h"
#include "tools/fit/parameter.h"

namespace loopwright {

/// A parameter that all records share, or that one record has for itself.
struct Unknown {
  static constexpr size_t shared = size_t(-1);
  std::string path;
  DiagramNumber number;  ///< with the bounds of the fit
  size_t record = shared;
};

class FitModel {
 public:
  /// Throws InputError with every problem.
  FitModel(const std::string& diagram, const std::vector<std::string>& experiments,
           const std::vector<std::string>& parameters, const LoadOptions& options,
           const FitOptions& fit_options);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  std::vector<double> start() const;
  int simulations() const { return simulations_; }
  bool is_interrupted() const { return fit_options_.interrupt && *fit_options_.interrupt; }

  struct Record {
    std::string path;  ///< of the experiment
    std::shared_ptr<const Experiment> experiment;
    bool is_held_out = false;
    /// Of a signal with so many rows.
    size_t fitted_rows(size_t rows) const;
  };
  const std::vector<Record>& records() const { return records_; }
  /// Errors of a record, without their offsets if that is wanted. Throws InputError when the blocks reject
  /// the values.
  Comparison simulate(size_t record, const std::vector<double>& values);
  /// The same of every record.
  std::vector<Comparison> simulate(const std::vector<double>& values);

  using Weights = std::map<std::string, double>;  ///< by port
  /// The inverse of each port's rms error over the fitted rows of all records.
  Weights weights_of(const std::vector<Comparison>& all) const;
  /// Σ n ln(mean square) over the ports: twice the negative log-likelihood with errors of unknown size.
  double profile(const std::vector<Comparison>& all) const;
  /// Weighted errors of the fitted rows: record after record, signal after signal. Empty when a run does not
  /// reach its end.
  std::vector<double> errors(const std::vector<double>& values, const Weights& weights);
  /// The derivatives of the errors that were computed last, by central differences; empty after a failed run.
  Eigen::MatrixXd jacobian(const std::vector<double>& values, const Weights& weights,
                           const std::vector<double>& errors);
  /// Of each error the instant of its row: rows of all records, one record after the other.
  const std::vector<size_t>& rows_of_errors() const { return rows_of_errors_; }

 private:
  std::vector<std::string> paths() const;
  std::vector<double> errors(size_t record, const std::vector<double>& values, const Weights& weights);
  void find_unknowns(const std::vector<std::string>& parameters, Problems& problems);
  void refuse_known(const std::string& path, Problems& problems) const;
  void bound(Unknown& unknown, Problems& problems) const;
  struct Squares {
    double sum = 0, rows = 0, size = 0, resolution = 0;
  };
  std::map<std::string, Squares> squares_of(const std::vector<Comparison>& all) const;

  std::string diagram_;
  LoadOptions options_;
  FitOptions fit_options_;
  RunOptions run_options_;
  std::vector<Record> records_;
  std::vector<Unknown> unknowns_;
  std::vector<size_t> rows_of_errors_, errors_of_record_;  // of the last errors()
  int simulations_ = 0;
};

/// Of differences that stand for derivatives. Large steps: where friction sticks and releases, errors jump
/// from step to step, and small differences measure only these jumps.
double derivative_step(double start, double value);

/// The unit of an unknown in an optimization: of the size that it has at the start.
double scale_of(const DiagramNumber& number);

}  // namespace loopwright
