#include <algorithm>
#include "tools/diagnose/search/jumps.h"
#include "tools/diagnose/search/names.h"
#include "tools/diagnose/search/search_steps.h"
#include "tools/diagnose/search/spectrum.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {

std::vector<const Shape*> Search::shapes_without_name() {
  nameless_ = shapes_of(unknown_, best_.motion);
  std::ranges::move(jump_shapes(trials_, best_, unknown_), std::back_inserter(nameless_));
  std::ranges::move(periodic_shapes(trials_, best_, unknown_, 1), std::back_inserter(nameless_));
  std::vector<const Shape*> list;
  for (const Shape& shape : nameless_) list.push_back(&shape);
  return list;
}

std::vector<Proposal> Search::without_name() {
  std::vector<Proposal> proposals =
      Evidence(trials_, best_, shapes_without_name(), candidates_.size()).extensions();
  note(proposals);
  if (proposals.size() > 2) proposals.resize(2);
  return proposals;
}

void Search::take_nameless(Estimate better) {
  take(std::move(better));
  note("without a name");
  prune();
}

bool Search::explain_without_name() {
  Estimate best;
  double best_score = score(best_) - worth_losing_names(trials_);
  for (const Proposal& proposal : without_name()) {
    Estimate trial = refined(applied(proposal, best_.members), 2);
    if (!trial.is_valid || score(trial) >= best_score) continue;
    best_score = score(trial), best = std::move(trial);
  }
  if (!best.is_valid) return false;
  take_nameless(std::move(best));
  return true;
}

std::vector<std::vector<Member>> Search::starts_without_name() {
  std::vector<std::vector<Member>> starts;
  for (Proposal& proposal : without_name()) starts.push_back(std::move(proposal.added));
  evidence_.reset();  // its shapes are computed again
  std::vector<const Shape*> shapes = shapes_without_name();
  std::ranges::copy(all_shapes(), std::back_inserter(shapes));
  std::optional<Proposal> pair = Evidence(trials_, best_, shapes, candidates_.size()).best_pair(true);
  if (pair) add_if_other(starts, std::move(pair->added));
  return starts;
}

bool Search::start_from_what_has_no_name() {
  Estimate best = std::move(best_);
  const Estimate nominal = fit_members(trials_, {}, noise_, motion_, 0);
  take(nominal);
  std::vector<std::vector<Member>> starts = starts_without_name();
  for (const Member& member : best.members)
    if (member.candidate->is_unknown) add_if_other(starts, {member});
  bool is_complete = false;
  for (std::vector<Member>& start : starts) {
    if (is_spent()) break;
    take(nominal);
    take(refined(start, 4));
    if (!best_.is_valid || score(best_) >= score(nominal)) continue;
    note("started without a name");
    const bool is_grown = !grow_beside_function(best, starts);
    best = fit_members(trials_, best.members, noise_, best.motion, 1);  // noise in its present state
    const bool loses_names =
        has_function_without_name(best_.members) && !has_function_without_name(best.members);
    const double least = loses_names ? worth_losing_names(trials_) : 0;
    const bool leaves_nothing = is_grown && seems_explained(trials_, best_);
    is_complete = score(best_) < score(best) - least;
    if (is_complete) best = std::move(best_);
    is_complete &= leaves_nothing;
    if (leaves_nothing) break;  // the others can explain no more
  }
  take(std::move(best));
  note("best of all");
  return is_complete;
}

bool Search::grow_beside_function(const Estimate& other, const std::vector<std::vector<Member>>& starts) {
  constexpr size_t further = 3;
  const Estimate before = best_;
  if (!grow(1)) return false;
  if (promised_mean_square(before, further) >= mean_square_now(other)) return true;
  if (best_.mean_square >= criteria::well_explained) exchange_function(starts);
  return grow(further);
}

void Search::exchange_function(const std::vector<std::vector<Member>>& starts) {
  Estimate present = best_;
  const std::vector<Member> named = named_members(present.members);
  if (is_spent() || named.empty() || named.size() == present.members.size()) return;
  take(refined(named, 2));
  double least = score(present) - criteria::clearly_better;
  Estimate better;
  for (const Proposal& proposal : without_name()) {
    const auto begins = [&](const std::vector<Member>& start) { return are_alike(start, proposal.added); };
    if (std::ranges::any_of(starts, begins)) continue;
    Estimate trial = refined(applied(proposal, best_.members), 4);
    if (!trial.is_valid || score(trial) >= least) continue;
    least = score(trial), better = std::move(trial);
  }
  take(better.is_valid ? better : present);
  if (!better.is_valid) return;
  note("with another function");
  sharpen_noise();
}

}  // namespace loopwright::diagnosis
