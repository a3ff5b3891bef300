#include "tools/diagnose/search/gaps.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_gaps = 4;
/// Gaps that differ by a smaller factor are neighbours on the grid.
constexpr double next_gap = 1.15;
/// What a fit reaches from a gap, as a factor; so many steps of it lie between neighbours.
constexpr double fine_step = 1.015;
constexpr int fine_steps = 5;

/// The shapes of a load in this gap with the contact of another load: the last shapes of each are its
/// resonance.
std::vector<double> with_contact_of(const Member& load, const Candidate& candidate, double gap) {
  std::vector<double> point{std::clamp(gap, candidate.nonlinear[0].low, candidate.nonlinear[0].high)};
  const size_t count = candidate.nonlinear.size(), own = load.nonlinear.size();
  for (size_t i = 1; i < count; ++i) {
    const CandidateParameter& range = candidate.nonlinear[i];
    const bool has_it = count - i <= own;
    point.push_back(
        std::clamp(has_it ? load.nonlinear[own + i - count] : range.start, range.low, range.high));
  }
  return point;
}

double gap_of(const Proposal& proposal) { return proposal.added.front().nonlinear[0]; }

/// Loads in gaps.
struct Gaps {
  const Trials& trials;
  const Estimate& estimate;
  const Candidate& candidate;
  const Member& load;           ///< with this contact
  std::vector<size_t> removed;  ///< members whose place they take

  /// What they promise, best first, without the neighbours of better ones.
  std::vector<Proposal> best_of(const std::vector<double>& gaps) const {
    std::vector<std::vector<double>> points;
    for (const double gap : gaps) points.push_back(with_contact_of(load, candidate, gap));
    std::vector<Shape> shapes;
    add_shapes(candidate, points, estimate.motion, shapes);
    add_without_doubt(trials, estimate.motion, shapes);
    std::vector<const Shape*> all;
    for (const Shape& shape : shapes) all.push_back(&shape);
    constexpr size_t catalogue = 1;  // all of them cost the same
    std::vector<Proposal> best;
    for (const Proposal& proposal : Evidence(trials, estimate, all, catalogue).each_shape(removed)) {
      const auto is_near = [&](const Proposal& other) {
        return std::abs(std::log(gap_of(proposal) / gap_of(other))) < std::log(next_gap);
      };
      if (std::ranges::none_of(best, is_near)) best.push_back(proposal);
      if (best.size() == most_gaps) break;
    }
    return best;
  }
  std::vector<Proposal> best() const {
    std::vector<double> fine;
    for (const Proposal& coarse : best_of(candidate.nonlinear[0].grid))
      for (int step = -fine_steps; step <= fine_steps; ++step)
        fine.push_back(gap_of(coarse) * std::pow(fine_step, step));
    return fine.empty() ? std::vector<Proposal>{} : best_of(fine);
  }
};

}  // namespace

std::vector<Proposal> gaps_for_springs(const Trials& trials, const Estimate& estimate,
                                       const std::vector<Candidate>& candidates) {
  std::vector<Proposal> list;
  for (size_t m = 0; m < estimate.members.size(); ++m)
    for (const Candidate& candidate : candidates)
      if (const Member& load = estimate.members[m];
          candidate.switched_load && load.candidate->linear_load && is_own_load(load))
        std::ranges::move(Gaps{trials, estimate, candidate, load, {m}}.best(), std::back_inserter(list));
  return list;
}

std::vector<std::vector<Member>> other_gaps(Trials& trials, const Estimate& estimate, size_t load) {
  constexpr int iterations = 4;
  const Estimate rest =
      fit_members(trials, without_one(estimate.members, load), estimate.noise, estimate.motion, iterations);
  std::vector<std::vector<Member>> list;
  if (!rest.is_valid) return list;
  const Member& present = estimate.members[load];
  for (const Proposal& proposal : Gaps{trials, rest, *present.candidate, present, {}}.best())
    list.push_back(applied(proposal, rest.members));
  return list;
}

}  // namespace loopwright::diagnosis
