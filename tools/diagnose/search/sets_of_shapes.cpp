/// Evidence for several shapes at once.
#include <algorithm>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {
namespace {

/// Sets of one size from which those of the next size are made: a beam search.
constexpr size_t kept_sets = 100;
/// How far outside two points of a grid a shape may lie, in their distance.
constexpr double outside_points = 0.5;

/// Of the second of two points in a shape that lies between them, by the greatest of its amplitudes.
double share_of_second(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  Eigen::Index greatest = 0;
  (first + second).cwiseAbs().maxCoeff(&greatest);
  return second[greatest] / (first[greatest] + second[greatest]);
}

bool is_within(const CandidateParameter& range, double value) {
  return value >= range.low && value <= range.high;
}

}  // namespace

std::vector<Evidence::Between> Evidence::between_points() const {
  std::vector<Between> list;
  for (size_t s = 0; s < shapes_.size(); ++s) {
    const bool is_fixed = shapes_[s]->candidate->nonlinear.empty();
    const bool has_next = s + 1 < shapes_.size() && shapes_[s + 1]->candidate == shapes_[s]->candidate;
    if (is_fixed || has_next) list.push_back({s, has_next && !is_fixed});
  }
  return list;
}

/// Sets with one shape more, of another candidate.
std::vector<std::vector<Evidence::Between>> Evidence::extended(const std::vector<Set>& sets,
                                                               const std::vector<Between>& all) const {
  std::vector<std::vector<Between>> result;
  for (const Set& set : sets)
    for (const Between& added : all) {
      const auto is_same = [&](const Between& b) {
        return shapes_[b.shape]->candidate == shapes_[added.shape]->candidate;
      };
      if (std::ranges::any_of(set.shapes, is_same)) continue;
      result.push_back(set.shapes);
      result.back().insert(std::ranges::upper_bound(result.back(), added), added);
    }
  std::ranges::sort(result);
  result.erase(std::ranges::unique(result).begin(), result.end());
  return result;
}

std::vector<int> Evidence::columns_of(const std::vector<Between>& set) const {
  std::vector<size_t> shapes;
  for (const Between& b : set)
    for (size_t s = b.shape; s <= b.shape + (b.has_next ? 1 : 0); ++s) shapes.push_back(s);
  return columns_of(shapes);
}

/// The members that amplitudes of the columns make up; empty: a parameter is outside its range.
std::vector<Member> Evidence::members_of(const std::vector<Between>& set,
                                         const Eigen::VectorXd& theta) const {
  std::vector<Member> members;
  Eigen::Index at = 0;
  for (const Between& b : set) {
    const Candidate& candidate = *shapes_[b.shape]->candidate;
    const Eigen::Index width = width_of(b.shape);
    Eigen::VectorXd amplitudes = theta.segment(at, width);
    Member member{&candidate, {}, shapes_[b.shape]->nonlinear};
    at += width;
    if (b.has_next) {
      const Eigen::VectorXd second = theta.segment(at, width);
      const double share = share_of_second(amplitudes, second);
      if (!(share >= -outside_points && share <= 1 + outside_points)) return {};
      const CandidateParameter& range = candidate.nonlinear.front();
      const double from = member.nonlinear.front(), to = shapes_[b.shape + 1]->nonlinear.front();
      const double value = range.logarithmic ? from * std::pow(to / from, share) : std::lerp(from, to, share);
      member.nonlinear.front() = std::clamp(value, range.low, range.high);
      amplitudes += second, at += width;
    }
    member.linear.assign(amplitudes.begin(), amplitudes.end());
    for (size_t i = 0; i < member.linear.size(); ++i)
      if (!is_within(candidate.linear[i], member.linear[i])) return {};
    members.push_back(std::move(member));
  }
  return members;
}

/// What a set saves; empty: a parameter is outside its range.
std::optional<double> Evidence::gain_of_set(const std::vector<Between>& set, const Errors& errors,
                                            double n) const {
  const Added added = add(G_, columns_of(set), errors.members, errors.b);
  if (members_of(set, added.theta).empty()) return {};
  double cost = 0;
  for (const Between& b : set) cost += price(parameters_of(*shapes_[b.shape]->candidate), 1, n, catalogue_);
  for (size_t m : errors.removed) cost -= price(parameters_of(*members_[m].candidate), 1, n, catalogue_);
  return n * std::log(explained_ / left_by(added.squares, errors.squares)) - cost;
}

Proposal Evidence::with_step(const Set& set, const Errors& errors) const {
  const Eigen::VectorXd theta = add(G_, columns_of(set.shapes), errors.members, errors.b).theta;
  const Eigen::VectorXd before = add(G_, columns_of(set.shapes), errors.amplitudes, errors.b).before;
  return {errors.removed, members_of(set.shapes, theta), step_of(errors.removed, before), set.gain};
}

/// The best for each set of candidates, without those that contain all that was removed.
std::vector<Proposal> Evidence::best_of_each(const std::vector<Set>& sets, const Errors& errors) const {
  std::vector<const Candidate*> present;
  for (size_t m : errors.removed) present.push_back(members_[m].candidate);
  std::ranges::sort(present);
  std::vector<std::vector<const Candidate*>> told;
  std::vector<Proposal> list;
  for (const Set& set : sets) {
    std::vector<const Candidate*> candidates;
    for (const Between& b : set.shapes) candidates.push_back(shapes_[b.shape]->candidate);
    std::ranges::sort(candidates);
    if (std::ranges::find(told, candidates) != told.end() || std::ranges::includes(candidates, present))
      continue;
    told.push_back(std::move(candidates));
    list.push_back(with_step(set, errors));
  }
  return list;
}

std::vector<Proposal> Evidence::sets(const std::vector<size_t>& removed, size_t most, double n,
                                     double most_loss) {
  for (size_t s = 0; s < shapes_.size(); ++s)
    for (size_t other = 0; other < s; ++other) multiply(s, other);
  const Errors errors = errors_without(removed);
  const std::vector<Between> points = between_points();
  std::vector<Set> all, last{{}};
  for (size_t size = 0; size < most; ++size) {
    std::vector<Set> next;
    for (std::vector<Between>& shapes : extended(last, points))
      if (const auto gain = gain_of_set(shapes, errors, n)) next.push_back({std::move(shapes), *gain});
    std::ranges::stable_sort(next, std::ranges::greater{}, &Set::gain);
    std::ranges::copy_if(next, std::back_inserter(all), [&](const Set& s) { return s.gain > -most_loss; });
    if (next.size() > kept_sets) next.resize(kept_sets);
    last = std::move(next);
  }
  std::ranges::stable_sort(all, std::ranges::greater{}, &Set::gain);
  return best_of_each(all, errors);
}

}  // namespace loopwright::diagnosis
