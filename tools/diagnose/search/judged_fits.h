/// What all steps of a search at the sites share: real fits of candidates, the criterion that judges them,
/// and leaving out what it does not need.
#pragma once
#include <span>
#include <string>
#include <vector>
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

class JudgedFits {
 protected:
  /// Gauss-Newton steps of a candidate: after the first ones it shows which are hopeless.
  static constexpr int first_steps = 2, further_steps = 3, last_steps = 3;

  explicit JudgedFits(SiteFitter& fitter) : fitter_(fitter) {}

  SiteModel& model() { return fitter_.model(); }
  bool is_spent(double share) { return model().work().is_spent(share); }
  /// In -2 ln L, of a term.
  double gain_needed() const;
  void tell(const std::string& what, const SiteHypothesis& at);
  /// -2 ln L + p ln n + twice the cost of the prior.
  double criterion(const SiteHypothesis& h);
  /// With the cost of parameters that moved.
  double whole_criterion(const SiteHypothesis& h);
  /// Real fits of the best candidates; the best of them with its own noise.
  std::vector<SiteHypothesis> fits(const SiteHypothesis& at, std::span<const SiteCandidate> candidates);
  /// The best candidates after parameters and terms, at first also those about the nominal parameters: a
  /// strong term bends the parameters that are fitted without it.
  std::vector<SiteCandidate> candidates(const SiteHypothesis& at);

  /// Leaves out terms without which the likelihood hardly falls; whether there were any.
  bool remove_idle(SiteHypothesis& at);
  /// Leaves out a function that is a detail of a named law, and may have seemed more beside parameters that
  /// were bent; whether there was one.
  bool leave_out_detail(SiteHypothesis& at);
  /// Of a term that is left out; the places of later ones move.
  void forget_rivals_of(size_t term);

  SiteFitter& fitter_;
  SiteSearchResult result_;
  double readings_ = 0;

 private:
  size_t keys_ = 10;
};

}  // namespace loopwright::diagnosis
