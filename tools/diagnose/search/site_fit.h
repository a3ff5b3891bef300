/// Parameters of the diagram, coefficients of terms and noise, fitted to a record through the predictor.
#pragma once
#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <optional>
#include <vector>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// What is supposed about the diagram.
struct SiteHypothesis {
  std::vector<double> factors;  ///< of its parameters; 1: as the diagram states
  std::vector<bool> is_free;    ///< which parameters are fitted
  std::vector<SiteTerm> terms;
  SiteNoise noise;
  double objective = 0;         ///< -2 ln L with this noise
  double scaled_objective = 0;  ///< the same with the best common scale of the noise

  size_t free_parameters() const { return size_t(std::count(is_free.begin(), is_free.end(), true)); }
  size_t changes() const { return terms.size() + free_parameters(); }
  /// Which parameters are fitted, by their numbers.
  std::vector<int> moved() const {
    std::vector<int> list;
    for (size_t i = 0; i < is_free.size(); ++i)
      if (is_free[i]) list.push_back(int(i));
    return list;
  }
};

/// The hypothesis without one of its terms, not fitted again.
inline SiteHypothesis without(SiteHypothesis at, size_t term) {
  at.terms.erase(at.terms.begin() + std::ptrdiff_t(term));
  return at;
}

/// One number of a hypothesis that is fitted.
struct FittedNumber {
  enum class Kind { factor, coefficient, nonlinear };
  Kind kind;
  int owner;      ///< the parameter or the term
  int index = 0;  ///< of the coefficient or of the shape's own parameter
};
std::vector<FittedNumber> fitted_numbers(const SiteHypothesis& hypothesis);
double& value_of(SiteHypothesis& hypothesis, const FittedNumber& number);

/// Number of parameters for an information criterion.
size_t size_of(const SiteHypothesis& hypothesis);

class SiteFitter {
 public:
  /// Over the first `rows` rows of the record.
  SiteFitter(SiteFilter& filter, size_t rows, std::function<bool()> is_interrupted);
  /// [s] Of slow noise: what is faster is white noise, what is slower takes out what offsets and drifts would
  /// explain.
  double shortest_slow_time() const { return 2 * filter_.model().record().sample_time; }
  double longest_slow_time() const { return longest_slow_time_; }

  SiteFilter& filter() { return filter_; }
  SiteModel& model() { return filter_.model(); }
  size_t rows() const { return rows_; }
  bool is_interrupted() const { return is_interrupted_(); }
  /// Shapes with a name that the search offers; they outlive the fitter.
  std::span<const TermShape> shapes() const { return shapes_; }
  void offer(std::span<const TermShape> shapes) { shapes_ = shapes; }

  /// fit(fitter, 0) … fit(fitter, count - 1), on all processors, each by a fitter with a model of its own
  /// that knows what this one knows. What it leaves must depend on nothing else, and it must not change the
  /// steps of the integration, as anneal() of a law with a memory does.
  void side_by_side(size_t count, const std::function<void(SiteFitter&, size_t)>& fit);

  /// A whole pass; false if the model diverges. Sets the hypothesis' objectives.
  bool pass(SiteHypothesis& hypothesis, bool with_columns, SitePass& to);
  /// Gauss-Newton steps on all fitted numbers, judged by whole passes, with a weak prior on the factors of
  /// parameters. The derivatives stay as long as steps do what they promise.
  void refine(SiteHypothesis& hypothesis, int steps);
  /// Maximum likelihood of the noise, linearized about a pass.
  void fit_noise(SiteHypothesis& hypothesis);
  /// The likelihood has two optima: much noise in the states and little in the sensors, and the reverse.
  /// Parameters are biased in the wrong one. Noise in the states is therefore made small, parameters and
  /// noise are fitted, as long as the likelihood improves.
  void anneal(SiteHypothesis& hypothesis);
  /// The scaled objective with the gains and variances of a pass: what a change gains, in one run of the
  /// model in the place of one for each state. Infinite if the model diverges.
  double scaled_objective_beside(const SiteHypothesis& hypothesis, const SitePass& about);
  /// Derivatives of the whitened errors with respect to all fitted numbers, as columns; a missing reading is
  /// zero. At the edge of what the diagram can be run with, the difference is taken on the other side; zero
  /// if it cannot be run on either.
  Eigen::MatrixXd jacobian(const SiteHypothesis& hypothesis, const SitePass& about);
  Eigen::VectorXd whitened(const SitePass& pass) const;
  /// Bounds and step of a number for differences.
  double step_of(const SiteHypothesis& hypothesis, const FittedNumber& number) const;

 private:
  struct Normal;
  struct Other;
  void solve(const SiteHypothesis& hypothesis, const std::vector<FittedNumber>& numbers,
             Normal& normal) const;
  void use(const SiteHypothesis& hypothesis);
  void shorten_steps(SiteHypothesis& hypothesis);
  SiteNoise best_noise(const SitePass& pass, const SiteNoise& from) const;
  std::optional<SiteNoise> evened(const SiteNoise& noise) const;
  void keep_within_limits(SiteHypothesis& hypothesis, const FittedNumber& number, double before) const;

  SiteFilter& filter_;
  const size_t rows_;
  const double longest_slow_time_;
  std::function<bool()> is_interrupted_;
  std::span<const TermShape> shapes_ = named_shapes();
  SitePass pass_;
  std::vector<double> errors_;
  std::vector<std::shared_ptr<Other>> others_;  // for other threads
};

}  // namespace loopwright::diagnosis
