#include "tools/diagnose/search/laws_of_one_variable.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/trail.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_laws = 3, most_sets_tried = 3;
/// [criterion] What is promised to lose more is not tried: between the points of a grid a promise is that
/// good.
constexpr double most_promised_loss = 20;
/// Between two points of a grid: what lies between is a sum of both only nearby.
constexpr int points_between = 1;
constexpr int steps_of_fit = 4;  // Gauss-Newton

/// Dry friction too, although it remembers where the axis turned.
bool is_law_of(const Candidate& candidate, const std::string& variable) {
  if (candidate.is_periodic || candidate.amplitude_is_one) return false;
  return candidate.law_of == variable || (variable == "velocity" && is_dry_friction(candidate));
}

/// The grid with points between, of a law with one shape.
std::vector<std::vector<double>> fine_grid(const Candidate& candidate) {
  std::vector<std::vector<double>> points;
  const CandidateParameter& parameter = candidate.nonlinear.front();
  for (size_t i = 0; i < parameter.grid.size(); ++i) {
    points.push_back({parameter.grid[i]});
    for (int part = 1; part <= points_between && i + 1 < parameter.grid.size(); ++part) {
      const double share = double(part) / (points_between + 1), from = parameter.grid[i],
                   to = parameter.grid[i + 1];
      points.push_back(
          {parameter.logarithmic ? from * std::pow(to / from, share) : std::lerp(from, to, share)});
    }
  }
  return points;
}

std::vector<Shape> shapes_of_laws(const std::vector<Candidate>& candidates, const std::string& variable,
                                  const Motion& motion) {
  const std::vector<std::vector<double>> no_shape{{}};
  std::vector<Shape> shapes;
  for (const Candidate& candidate : candidates) {
    if (!is_law_of(candidate, variable) || candidate.nonlinear.size() > 1) continue;
    add_shapes(candidate, candidate.nonlinear.empty() ? no_shape : fine_grid(candidate), motion, shapes);
  }
  return shapes;
}

}  // namespace

std::vector<Proposal> other_laws(const Trials& trials, const Estimate& estimate,
                                 const std::vector<Candidate>& candidates, const std::string& variable,
                                 double most_loss) {
  std::vector<size_t> laws;
  for (size_t m = 0; m < estimate.members.size(); ++m)
    if (is_law_of(*estimate.members[m].candidate, variable)) laws.push_back(m);
  if (laws.empty()) return {};
  const std::vector<Shape> shapes = shapes_of_laws(candidates, variable, estimate.motion);
  std::vector<const Shape*> all;
  for (const Shape& shape : shapes) all.push_back(&shape);
  Evidence evidence(trials, estimate, all, candidates.size());
  return evidence.sets(laws, most_laws, double(fitted_numbers(trials)), most_loss);
}

std::optional<Estimate> better_laws(Trials& trials, const Estimate& best,
                                    const std::vector<Candidate>& candidates, const std::string& variable,
                                    std::vector<std::string>& trail) {
  std::vector<Proposal> sets = other_laws(trials, best, candidates, variable, most_promised_loss);
  if (sets.size() > most_sets_tried) sets.resize(most_sets_tried);
  if (sets.empty()) return {};
  std::optional<Estimate> better;
  const Estimate own = with_own_noise(trials, best, steps_of_fit);
  double most_gain = criteria::clearly_better;
  for (const Proposal& set : sets) {
    if (trials.work->is_spent(criteria::work_of_search)) break;
    Estimate trial = fit_members(trials, applied(set, best.members), best.noise, best.motion, steps_of_fit);
    if (trial.is_valid) trial = with_own_noise(trials, std::move(trial), steps_of_fit);
    if (!trial.is_valid) continue;
    const double gain =
        criterion(trials, own, candidates.size()) - criterion(trials, trial, candidates.size());
    trail.push_back(fmt::format("tried other laws of {}, {}: promised {:+.1f}, criterion {:+.1f}", variable,
                                names_of(set.added), -set.gain, -gain));
    if (gain > most_gain) most_gain = gain, better = std::move(trial);
  }
  return better;
}

std::optional<Estimate> function_of_velocity(Trials& trials, const Estimate& best,
                                             const std::vector<Candidate>& unknown, size_t catalogue,
                                             std::vector<std::string>& trail) {
  std::vector<Member> members = best.members;
  const auto is_of_velocity = [](const Candidate& c) { return c.law_of == "velocity"; };
  const size_t stacked =
      std::erase_if(members, [&](const Member& m) { return is_of_velocity(*m.candidate); });
  const auto function = std::ranges::find_if(unknown, is_of_velocity);
  if (stacked < 2 || function == unknown.end()) return {};
  members.push_back({&*function, std::vector<double>(function->linear.size()), {}});
  // Each with its own noise: what a name leaves is taken for noise otherwise, and then hides in it.
  Estimate trial = fit_members(trials, members, best.noise, best.motion, steps_of_fit);
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
