#include "tools/diagnose/search/laws_of_one_variable.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remembered_runs.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_laws = 3, most_sets_tried = 3;
constexpr int steps_of_fit = 4;  // Gauss-Newton

/// Dry friction too, although it remembers where the axis turned. Of laws with several shapes none is tried.
bool is_law_of(const Candidate& candidate, LawOf variable) {
  if (candidate.is_periodic || candidate.amplitude_is_one || candidate.nonlinear.size() > 1) return false;
  return candidate.law_of == variable || (variable == LawOf::velocity && is_dry_friction(candidate));
}

/// Of a grid, and of those of all laws: the time for a set grows with the square.
constexpr size_t most_points = 32, most_points_of_all = 640;

/// At most so many points of a grid, with one between two of them where they are fewer than half.
std::vector<std::vector<double>> points_of(const Candidate& candidate, size_t most) {
  if (candidate.nonlinear.empty()) return {{}};
  const CandidateParameter& parameter = candidate.nonlinear.front();
  const std::vector<double>& grid = parameter.grid;
  const size_t every = (grid.size() + most - 1) / most;
  std::vector<std::vector<double>> points;
  for (size_t i = 0; i < grid.size(); i += every) {
    points.push_back({grid[i]});
    if (2 * grid.size() > most || i + 1 == grid.size()) continue;
    points.push_back(
        {parameter.logarithmic ? std::sqrt(grid[i] * grid[i + 1]) : std::midpoint(grid[i], grid[i + 1])});
  }
  return points;
}

Shapes shapes_of_laws(const Trials& trials, const std::vector<Candidate>& candidates, LawOf variable,
                      const Motion& motion, const std::vector<const Candidate*>& refused) {
  std::vector<const Candidate*> laws;
  for (const Candidate& candidate : candidates)
    if (is_law_of(candidate, variable) && !is_among(refused, candidate)) laws.push_back(&candidate);
  const size_t most =
      std::clamp<size_t>(most_points_of_all / std::max<size_t>(laws.size(), 1), 2, most_points);
  return trials.remembered->shapes(laws, motion, [&] {
    std::vector<Shape> shapes;
    for (const Candidate* law : laws) add_shapes(*law, points_of(*law, most), motion, shapes);
    return shapes;
  });
}

}  // namespace

std::vector<Proposal> other_laws(const Trials& trials, const Estimate& estimate,
                                 const std::vector<Candidate>& candidates, LawOf variable, double most_loss,
                                 const std::vector<const Candidate*>& refused) {
  std::vector<size_t> laws;
  for (size_t m = 0; m < estimate.members.size(); ++m)
    if (is_law_of(*estimate.members[m].candidate, variable)) laws.push_back(m);
  if (laws.empty()) return {};
  const Shapes shapes = shapes_of_laws(trials, candidates, variable, estimate.motion, refused);
  std::vector<const Shape*> all;
  for (const Shape& shape : *shapes) all.push_back(&shape);
  Evidence evidence(trials, estimate, all, candidates.size());
  trials.work->add(size_t(evidence.rows()), double(all.size() * all.size()) * Work::of_a_product);
  return evidence.sets(laws, most_laws, double(fitted_numbers(trials)), most_loss);
}

std::vector<std::vector<Member>> with_other_laws(const Trials& trials, const Estimate& estimate,
                                                 const std::vector<Candidate>& candidates, LawOf variable) {
  std::vector<std::vector<Member>> list;
  for (const Proposal& set :
       other_laws(trials, estimate, candidates, variable, criteria::most_promised_loss_of_laws))
    if (list.size() < most_sets_tried) list.push_back(applied(set, estimate.members));
  return list;
}

std::optional<Estimate> function_of_velocity(Trials& trials, const Estimate& best,
                                             const std::vector<Candidate>& unknown, size_t catalogue,
                                             std::vector<std::string>& trail) {
  std::vector<Member> members = best.members;
  const auto is_of_velocity = [](const Candidate& c) { return c.law_of == LawOf::velocity; };
  const size_t stacked =
      std::erase_if(members, [&](const Member& m) { return is_of_velocity(*m.candidate); });
  const auto function = std::ranges::find_if(unknown, is_of_velocity);
  if (stacked < 2 || function == unknown.end() || trials.work->is_spent(criteria::work_of_search)) return {};
  members.push_back({&*function, std::vector<double>(function->linear.size()), {}});
  // Each with its own noise: what a name leaves is taken for noise otherwise, and then hides in it.
  Estimate trial = fit_members(trials, members, best.noise, best.motion, steps_of_fit);
  if (!trial.is_valid) return {};
  trial = with_own_noise(trials, std::move(trial), steps_of_fit);
  const Estimate names = with_own_noise(trials, best, steps_of_fit);
  if (!trial.is_valid || !names.is_valid) return {};
  const double gain = criterion(trials, names, catalogue) - criterion(trials, trial, catalogue);
  trail.push_back(
      fmt::format("tried a function of velocity in place of {} names: criterion {:+.1f}", stacked, -gain));
  const double least = criteria::least_gain_without_name +
                       criteria::least_gain_over_stacked_names_per_row * double(fitted_numbers(trials));
  if (gain < least) return {};
  return trial;
}

}  // namespace loopwright::diagnosis
