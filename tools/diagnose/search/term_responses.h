/// How the whitened errors of a pass respond to terms, beside all that is free already.
#pragma once
#include <Eigen/Dense>
#include <array>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

class TermResponses {
 public:
  /// About this hypothesis, whose objectives it sets.
  TermResponses(SiteFitter& fitter, SiteHypothesis& at);
  /// False if the model diverges; nothing else may be asked then.
  bool is_good() const { return is_good_; }
  const SitePass& pass() const { return pass_; }
  /// A variable along the path, at the start of each sample; -1: zero.
  std::vector<double> signal(int variable) const;
  /// The term's columns along the path, which are the same at every site. What is evaluated in the middle
  /// alone is supposed to stay so over each sample.
  void evaluate(const SiteTerm& term, bool in_middle_alone);
  /// The responses to the evaluated columns at a site, at coefficients of one; completes the term.
  Eigen::MatrixXd responses(SiteTerm& term, int site);
  /// The response to a change of a recorded input, without what is free.
  Eigen::MatrixXd response_of_input(int site, const InputLines& change);
  /// Takes away what the numbers that are free could do.
  void leave_out_free(Eigen::MatrixXd& columns) const { columns -= basis_ * (basis_.transpose() * columns); }
  /// Least squares of the remaining errors; the gain in -2 ln L. Sets the term's coefficients.
  double explain(const Eigen::MatrixXd& columns, SiteTerm& term) const;

 private:
  SiteFitter& fitter_;
  SitePass pass_;
  bool is_good_ = false;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd rest_;
  std::array<std::vector<double>, 3> phi_;    // at the start, middle and end of each sample
  bool is_in_middle_alone_ = false;           // and then in the middle for all of it
  std::array<double, most_columns> sizes_{};  // rms of the columns
};

}  // namespace loopwright::diagnosis
