#include "tools/diagnose/inquiry.h"
#include <algorithm>
#include <utility>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/friction_at_reversals.h"
#include "tools/diagnose/search/hidden_in_noise.h"
#include "tools/diagnose/search/names.h"
#include "tools/diagnose/search/replacement.h"
#include "tools/diagnose/search/rivals.h"
#include "tools/diagnose/search/unknown.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {

Inquiry::Inquiry(Trials& trials, const Motion& motion, const Catalogue& catalogue, const RecordSizes& sizes,
                 const std::function<void(const char*, double)>& progress)
    : trials_(trials),
      motion_(motion),
      catalogue_(catalogue),
      unknown_(unknown_forces(sizes, trials.has_map(), trials.has_mass())),
      progress_(progress) {}

Conclusion Inquiry::with_names() {
  const SearchResult found = searched();
  const Estimate& e = found.estimate;
  // What remains unexplained anyway also appears there.
  if (seems_explained(trials_, e) && holds_out_something_else(e) &&
      holds_out_something_else(with_fitted_noise(e)))
    return with_all_rows(found.trail, e);
  Conclusion conclusion = concluded(found.trail, e);
  if (conclusion.is_white() && holds_out_something_else(conclusion.estimate))
    return with_all_rows(conclusion.trail, conclusion.estimate);
  if (conclusion.is_white())
    if (auto more = hidden_in_noise(trials_, conclusion.estimate, unknown_, catalogue_.candidates.size(),
                                    conclusion.trail))
      return concluded(std::move(conclusion.trail), *more);
  return gone_on(std::move(conclusion), e.members);
}

Conclusion Inquiry::without_names() {
  const std::vector<Shape>& shapes = shapes_along_fitted_rows();
  std::vector<const Candidate*> all;
  for (const Candidate& candidate : catalogue_.candidates) all.push_back(&candidate);
  Conclusion conclusion = conclude(trials_, catalogue_.candidates, shapes,
                                   fit_members(trials_, {}, search_noise(trials_), fitted_motion_, 0), all);
  look_at_all_rows(conclusion.estimate);
  return conclusion;
}

Conclusion Inquiry::without(const Conclusion& conclusion, size_t member) {
  forget_reversals(trials_);
  const std::vector<Shape>& shapes = shapes_along_fitted_rows();
  const Estimate& e = conclusion.estimate;
  refused_.push_back(e.members[member].candidate);
  Conclusion rest = conclude(
      trials_, catalogue_.candidates, shapes,
      in_place_of(trials_, e, member, conclusion.substitutes[member], refused_, catalogue_.candidates.size()),
      refused_);
  look_at_all_rows(rest.estimate);
  return rest;
}

SearchResult Inquiry::searched() {
  forget_reversals(trials_);
  const std::vector<Shape>& shapes = shapes_along_fitted_rows();
  progress_("searching", 0.4);
  return search(trials_, catalogue_.candidates, shapes, unknown_, fitted_motion_);
}

Conclusion Inquiry::concluded(std::vector<std::string> trail, const Estimate& found) {
  progress_("fitting effects and noise together", 0.7);
  Conclusion conclusion = conclude(trials_, catalogue_.candidates, shapes_along_fitted_rows(), found);
  std::ranges::move(conclusion.trail, std::back_inserter(trail));
  conclusion.trail = std::move(trail);
  look_at_all_rows(conclusion.estimate);
  return conclusion;
}

Conclusion Inquiry::gone_on(Conclusion conclusion, const std::vector<Member>& searched) {
  const std::vector<Member>& members = conclusion.estimate.members;
  const std::vector<Member> named = named_members(members);
  const bool has_no_name = named.size() < members.size();
  const bool leaves_something = has_no_name || !conclusion.is_white();
  const auto was_searched = [&](const Member& m) {
    return std::ranges::find(searched, m.candidate, &Member::candidate) != searched.end();
  };
  const bool is_new =
      has_no_name || 2 * size_t(std::ranges::count_if(members, was_searched)) <= members.size();
  if (named.empty() || !leaves_something || !is_new || trials_.work->is_spent(criteria::work_to_go_on))
    return conclusion;
  std::vector<std::vector<char>> with_reversals;
  for (const Trial& trial : trials_.list) with_reversals.push_back(trial.with_reversals);
  forget_reversals(trials_);
  SearchResult again =
      search_on(trials_, catalogue_.candidates, shapes_along_fitted_rows(), unknown_, fitted_motion_, named);
  std::ranges::copy(again.trail, std::back_inserter(conclusion.trail));
  const bool leaves_much = !again.estimate.is_valid || again.estimate.mean_square >= criteria::much_left;
  if (!leaves_much && !are_alike(again.estimate.members, members)) {
    Conclusion next = concluded(conclusion.trail, again.estimate);
    const bool leaves_nothing = next.is_white() && !has_function_without_name(next.estimate.members);
    if (leaves_nothing && is_better(next, conclusion)) return next;
    conclusion.trail = std::move(next.trail);
  }
  for (size_t t = 0; t < with_reversals.size(); ++t)
    trials_.list[t].with_reversals = std::move(with_reversals[t]);
  leave_out_doubtful(trials_, conclusion.estimate);
  look_at_all_rows(conclusion.estimate);
  return conclusion;
}

bool Inquiry::is_better(const Conclusion& next, const Conclusion& before) {
  // On the same rows: other members may make others doubtful.
  Estimate on_its_rows = next.estimate;
  leave_out_doubtful(trials_, on_its_rows);
  const auto criterion_of = [&](const Estimate& e) {
    return criterion(trials_, fit_members(trials_, e.members, e.noise, e.motion, 0),
                     catalogue_.candidates.size());
  };
  const double gain = criterion_of(before.estimate) - criterion_of(on_its_rows);
  look_at_all_rows(next.estimate);
  const bool gives_names =
      has_function_without_name(before.estimate.members) && !has_function_without_name(next.estimate.members);
  return gain > (gives_names ? -worth_losing_names(trials_) : criteria::clearly_better);
}

Conclusion Inquiry::with_all_rows(std::vector<std::string> trail, const Estimate& found) {
  constexpr int iterations = 8;
  std::vector<size_t> held_out_from;
  for (Trial& trial : trials_.list) {
    held_out_from.push_back(trial.held_out_from);
    trial.held_out_from = trial.usable.size();
  }
  fits_all_rows_ = true;
  forget_reversals(trials_);
  shapes_along_fitted_rows();
  Estimate again = fit_members(trials_, found.members, found.noise, fitted_motion_, iterations);
  leave_out_doubtful(trials_, again);
  const bool explains_all = seems_explained(trials_, again) && explains_rows_from(held_out_from, again);
  if (!explains_all && !trials_.work->is_spent(criteria::work_of_search)) {
    SearchResult anew = searched();
    std::ranges::move(anew.trail, std::back_inserter(trail));
    again = std::move(anew.estimate);
  }
  return concluded(std::move(trail), again);
}

bool Inquiry::explains_rows_from(std::vector<size_t> rows, const Estimate& estimate) {
  const auto exchange = [&] {
    for (size_t t = 0; t < rows.size(); ++t) std::swap(trials_.list[t].held_out_from, rows[t]);
  };
  exchange();
  const double left = mean_square(trials_, *estimate.fitted, true);
  exchange();
  return left < criteria::well_explained;
}

Estimate Inquiry::with_fitted_noise(Estimate estimate) {
  leave_out_doubtful(trials_, estimate);
  maximise(trials_, estimate);
  return estimate;
}

bool Inquiry::holds_out_something_else(const Estimate& estimate) {
  look_at_all_rows(estimate);
  return held_out_mean_square() > criteria::most_held_out * std::max(1.0, estimate.mean_square);
}

const std::vector<Shape>& Inquiry::shapes_along_fitted_rows() {
  trials_.run_along(Trials::Rows::fitted);
  std::vector<size_t> rows;
  for (const Trial& trial : trials_.list) rows.push_back(trial.rows());
  if (rows == rows_of_shapes_) return shapes_;
  progress_("running every effect's blocks on the records", 0.1);
  rows_of_shapes_ = std::move(rows);
  fitted_motion_ = cut(motion_, trials_);
  shapes_ = shapes_of(catalogue_.candidates, fitted_motion_);
  add_without_doubt(trials_, fitted_motion_, shapes_);
  return shapes_;
}

void Inquiry::look_at_all_rows(const Estimate& estimate) {
  trials_.run_along(Trials::Rows::all);
  on_all_rows_ = on_own_motion(trials_, fit_members(trials_, estimate.members, estimate.noise, motion_, 0));
  leave_out_doubtful(trials_, on_all_rows_);
  trials_.run_along(Trials::Rows::fitted);
}

}  // namespace loopwright::diagnosis
