#include "tools/diagnose/search/rivals.h"
#include <algorithm>
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/law_swaps.h"

namespace loopwright::diagnosis {

void maximise(Trials& trials, Estimate& estimate, double worst) {
  constexpr int iterations = 8;
  estimate = with_own_noise(trials, std::move(estimate), iterations, worst);
}

Estimate Rivals::fitted(const Proposal& proposal) const {
  constexpr int iterations = 4;
  Estimate other;
  if (is_refused(proposal)) return other;
  other.members = applied(proposal, estimate_.members);
  const double worst = worst_profile(other.members, criteria::most_promised_loss);
  return fit_members(trials_, std::move(other.members), estimate_.noise, estimate_.motion, iterations, worst);
}

double Rivals::worst_profile(const std::vector<Member>& members, double reaches) const {
  Estimate unfitted;
  unfitted.members = members;
  const double price = criterion_of(unfitted);
  return criterion_of(estimate_) + reaches * reach_ - price;
}

std::optional<double> Rivals::loss_of(const Proposal& proposal, const Estimate& other,
                                      double most_reaches) const {
  if (!other.is_valid) return {};
  size_t before = 0, now = 0;
  for (size_t m : proposal.removed) before += parameters_of(*estimate_.members[m].candidate);
  for (const Member& m : proposal.added) now += parameters_of(*m.candidate);
  const auto left = [](const Estimate& e) { return e.profile + e.against_at_rest; };
  if (now > before && left(other) > left(estimate_) - criteria::least_gain_of_larger_set) return {};
  const double loss = criterion_of(other) - criterion_of(estimate_);
  return loss < most_reaches * reach_ ? std::optional(loss) : std::nullopt;
}

std::optional<double> Rivals::loss_of(const Proposal& proposal) {
  if (is_spent()) return {};
  Estimate other = fitted(proposal);
  if (!other.is_valid) return {};
  if (const double loss = criterion_of(other) - criterion_of(estimate_); loss > reach_ && loss < 4 * reach_)
    maximise(trials_, other, worst_profile(other.members, 1));
  const std::optional<double> loss = loss_of(proposal, other);
  if (!loss || is_refuted(proposal, other)) return {};
  const double disliked = *loss - preference(trials_, other.members, estimate_.members);
  if (disliked < best_loss_) best_loss_ = disliked, best_ = std::move(other);
  return loss;
}

bool Rivals::is_refuted(const Proposal& p, const Estimate& other) const {
  const auto removed = std::ranges::find_if(
      p.removed, [&](size_t m) { return is_dry_friction(*estimate_.members[m].candidate); });
  const auto added =
      std::ranges::find_if(p.added, [](const Member& m) { return is_dry_friction(*m.candidate); });
  return removed != p.removed.end() && added != p.added.end() &&
         added->candidate != estimate_.members[*removed].candidate &&
         at_reversals_.is_refuted(*removed, *added->candidate, other);
}

bool Rivals::is_promised(const Proposal& proposal, const Estimate& other) const {
  return proposal.gain > 0 && other.is_valid &&
         criterion_of(other) - criterion_of(estimate_) < criteria::most_promised_loss * reach_;
}

std::optional<Estimate> Rivals::better(const std::function<double(const Estimate&)>& doubt) {
  const auto at_limit = [](const Estimate& e) { return std::ranges::count_if(e.members, is_at_limit); };
  const auto is_blurred = [&](const Member& m) { return !at_reversals_.is_resolved(m); };
  const auto blurred = [&](const Estimate& e) { return std::ranges::count_if(e.members, is_blurred); };
  if (!best_.is_valid || at_limit(best_) > at_limit(estimate_) || is_spent()) return {};
  if (blurred(best_) > blurred(estimate_)) return {};  // it is declared
  maximise(trials_, best_);
  const double gain = criterion_of(estimate_) - criterion_of(best_);
  return gain + preference(trials_, best_.members, estimate_.members) >
                 std::max(criteria::clearly_better, doubt(best_))
             ? std::optional(std::move(best_))
             : std::nullopt;
}

bool Rivals::is_refused(const Proposal& proposal) const {
  return std::ranges::any_of(proposal.added,
                             [&](const Member& member) { return is_among(refused_, *member.candidate); });
}

}  // namespace loopwright::diagnosis
