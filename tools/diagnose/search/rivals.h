/// Other sets of effects beside one that was found.
#pragma once
#include <functional>
#include <optional>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/friction_at_reversals.h"

namespace loopwright::diagnosis {

/// Fits parameters and noise together; `worst` is that of with_own_noise().
void maximise(Trials& trials, Estimate& estimate, double worst = std::numeric_limits<double>::infinity());

/// The set that was found, and those that explain the records as well.
class Rivals {
 public:
  /// `reach`: loss of the criterion that a rival may have. No rival contains a candidate that was refused.
  Rivals(Trials& trials, const Estimate& estimate, size_t catalogue, double reach,
         FrictionAtReversals& at_reversals, const std::vector<const Candidate*>& refused)
      : trials_(trials),
        estimate_(estimate),
        catalogue_(catalogue),
        reach_(reach),
        at_reversals_(at_reversals),
        refused_(refused) {}

  double reach() const { return reach_; }
  const std::vector<const Candidate*>& refused() const { return refused_; }
  /// No further rival is fitted.
  bool is_spent() const { return trials_.work->is_spent(criteria::work_with_rivals); }
  /// With a proposal applied and all parameters fitted, as long as it may come within reach; not valid with a
  /// candidate that was refused.
  Estimate fitted(const Proposal& proposal) const;
  /// How much worse its criterion is; empty: beyond `most_reaches` times the reach. A larger set that
  /// contains this one as a special case is always close, so it must explain more to be a rival.
  std::optional<double> loss_of(const Proposal& proposal, const Estimate& other,
                                double most_reaches = 1) const;
  std::optional<double> loss_of(const Proposal& proposal);
  /// Another law of dry friction in place of the one that is there, against which the rows after reversals
  /// speak.
  bool is_refuted(const Proposal& proposal, const Estimate& other) const;
  /// Whether it is as good on the same motion, and not much worse on its own motion. If the diagram itself
  /// quantizes, for example with an encoder, every run gives a different result.
  bool is_promised(const Proposal& proposal, const Estimate& other) const;
  /// The best of the sets whose loss was computed, if it is also better with noise of its own: the search
  /// compared them under the noise known then. `doubt`: what its gain must exceed when the errors that it
  /// leaves are not white.
  std::optional<Estimate> better(const std::function<double(const Estimate&)>& doubt);

 private:
  bool is_refused(const Proposal& proposal) const;
  /// Profile above which a set of these members loses more than so many reaches.
  double worst_profile(const std::vector<Member>& members, double reaches) const;
  double criterion_of(const Estimate& estimate) const { return criterion(trials_, estimate, catalogue_); }

  Trials& trials_;
  const Estimate& estimate_;
  size_t catalogue_;
  double reach_, best_loss_ = -criteria::clearly_better;
  FrictionAtReversals& at_reversals_;
  const std::vector<const Candidate*>& refused_;
  Estimate best_;
};

}  // namespace loopwright::diagnosis
