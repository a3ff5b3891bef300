#include "tools/diagnose/search/velocity_laws.h"
#include <algorithm>
#include <cmath>
#include <optional>

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_velocities = 2000;  // of all records, evenly spaced in the rows that count
constexpr double far_from_grid = 8;       // a shape comes so many times nearer between the points of the grid
/// Steps of its own parameters from there, which are speeds: factors.
constexpr double refinements[] = {1.2, 1.1, 1.05, 1.025};

bool is_law(const Candidate& candidate) {
  return candidate.is_of_velocity && !candidate.is_unknown && !candidate.amplitude_is_one;
}

bool is_in_range(const CandidateParameter& range, double value) {
  return value >= range.low && value <= range.high;
}

/// The rows at which sums are compared.
std::vector<std::vector<size_t>> compared_rows(const Trials& trials) {
  std::vector<std::vector<size_t>> rows(trials.list.size());
  const size_t every = fitted_numbers(trials) / trials.ports() / most_velocities + 1;
  size_t seen = 0;
  for (size_t t = 0; t < rows.size(); ++t)
    for (size_t k = 0; k < trials.list[t].held_out_from; ++k)
      if (trials.list[t].usable[k] && seen++ % every == 0) rows[t].push_back(k);
  return rows;
}

struct Law {
  const Candidate* candidate;
  std::vector<std::vector<double>> points;  ///< of its grid
};

/// A law in place of a member.
struct Swap {
  const Candidate* candidate = nullptr;
  std::vector<double> nonlinear;
  Eigen::VectorXd amplitudes;  ///< its own, then those of the laws that stay
  double apart = 0;            ///< [force] rms of the difference of the sums
};

/// The laws of the velocity among the members, by their values in the compared rows.
class Sum {
 public:
  Sum(const Trials& trials, const Estimate& estimate)
      : members_(estimate.members), motion_(estimate.motion), rows_(compared_rows(trials)) {
    for (const auto& rows : rows_) count_ += Eigen::Index(rows.size());
    force_.setZero(count_);
    for (const Member& member : members_) {
      of_each_.emplace_back(count_, 0);
      if (!is_law(*member.candidate)) continue;
      of_each_.back() = values(*member.candidate, {member.nonlinear}).front();
      const auto width = Eigen::Index(member.linear.size());
      force_ += of_each_.back() * Eigen::Map<const Eigen::VectorXd>(member.linear.data(), width);
      ++laws_;
    }
  }
  bool is_of_several() const { return laws_ > 1 && count_ > 0; }

  /// The nearest sum with a law in place of a member, of the points of its grid.
  Swap nearest(const Law& law, size_t removed) const {
    const Eigen::MatrixXd others = without(removed);
    const auto at = values(*law.candidate, law.points);
    Swap best;
    for (size_t p = 0; p < law.points.size(); ++p)
      keep_nearer(best, law.candidate, law.points[p], at[p], others);
    return best;
  }
  /// Between the points of the grid.
  void refine(Swap& swap, size_t removed) const {
    const Eigen::MatrixXd others = without(removed);
    for (double factor : refinements)
      for (size_t i = 0; i < swap.nonlinear.size(); ++i) {
        const CandidateParameter& range = swap.candidate->nonlinear[i];
        std::vector<std::vector<double>> points(2, swap.nonlinear);
        points[0][i] = std::min(points[0][i] * factor, range.high);
        points[1][i] = std::max(points[1][i] / factor, range.low);
        const auto at = values(*swap.candidate, points);
        for (size_t p = 0; p < 2; ++p) keep_nearer(swap, swap.candidate, points[p], at[p], others);
      }
  }
  /// Empty: an amplitude of it is outside its range, where no fit could begin.
  std::optional<Proposal> proposal(const Swap& swap, size_t removed) const {
    Proposal result{{removed}, {{swap.candidate, {}, swap.nonlinear}}, {}, 0};
    auto next = swap.amplitudes.begin();
    for (const CandidateParameter& range : swap.candidate->linear) {
      if (!is_in_range(range, *next)) return {};
      result.added.front().linear.push_back(*next++);
    }
    std::vector<Member> rest = members_;
    rest.erase(rest.begin() + std::ptrdiff_t(removed));
    for (const FreeParameter& p : free_parameters(rest)) {
      const bool changes = p.is_linear && is_law(*rest[p.member].candidate);
      if (changes && !is_in_range(range_of(rest, p), *next)) return {};
      result.step.push_back(changes ? *next++ - value_of(rest, p) : 0);
    }
    return result;
  }

 private:
  Eigen::MatrixXd values(const std::vector<Columns>& of_each_record) const {
    Eigen::MatrixXd result(count_, Eigen::Index(of_each_record.front().size()));
    for (Eigen::Index c = 0; c < result.cols(); ++c) {
      Eigen::Index at = 0;
      for (size_t t = 0; t < rows_.size(); ++t)
        for (size_t k : rows_[t]) result(at++, c) = double((*of_each_record[t][size_t(c)].mean)[k]);
    }
    return result;
  }
  std::vector<Eigen::MatrixXd> values(const Candidate& candidate,
                                      const std::vector<std::vector<double>>& points) const {
    std::vector<std::vector<Columns>> of_points(points.size());
    for (const auto& path : motion_.paths) {
      std::vector<Columns> columns = candidate.columns_at(*path, points);
      for (size_t p = 0; p < points.size(); ++p) of_points[p].push_back(std::move(columns[p]));
    }
    std::vector<Eigen::MatrixXd> result;
    for (const auto& columns : of_points) result.push_back(values(columns));
    return result;
  }
  Eigen::MatrixXd without(size_t removed) const {
    Eigen::MatrixXd others(count_, 0);
    for (size_t m = 0; m < members_.size(); ++m) {
      if (m == removed) continue;
      others.conservativeResize(Eigen::NoChange, others.cols() + of_each_[m].cols());
      others.rightCols(of_each_[m].cols()) = of_each_[m];
    }
    return others;
  }
  void keep_nearer(Swap& best, const Candidate* candidate, const std::vector<double>& nonlinear,
                   const Eigen::MatrixXd& own, const Eigen::MatrixXd& others) const {
    Eigen::MatrixXd all(count_, own.cols() + others.cols());
    all << own, others;
    Swap swap{candidate, nonlinear, all.colPivHouseholderQr().solve(force_)};
    swap.apart = (force_ - all * swap.amplitudes).norm() / std::sqrt(double(count_));
    if (!best.candidate || !(best.apart <= swap.apart)) best = std::move(swap);
  }

  const std::vector<Member>& members_;
  const Motion& motion_;
  std::vector<std::vector<size_t>> rows_;
  Eigen::Index count_ = 0;
  size_t laws_ = 0;
  std::vector<Eigen::MatrixXd> of_each_;
  Eigen::VectorXd force_;
};

/// Those that are no members.
std::vector<Law> other_laws(const std::vector<Shape>& shapes, const std::vector<Member>& members) {
  std::vector<Law> laws;
  for (const Shape& shape : shapes) {
    if (!is_law(*shape.candidate) ||
        std::ranges::find(members, shape.candidate, &Member::candidate) != members.end())
      continue;
    if (laws.empty() || laws.back().candidate != shape.candidate) laws.push_back({shape.candidate, {}});
    laws.back().points.push_back(shape.nonlinear);
  }
  return laws;
}

}  // namespace

std::vector<Proposal> velocity_law_swaps(const Trials& trials, const Estimate& estimate,
                                         const std::vector<Shape>& shapes) {
  const Sum sum(trials, estimate);
  if (!sum.is_of_several()) return {};
  const auto laws = other_laws(shapes, estimate.members);
  const double most_apart = estimate.noise.white;
  std::vector<std::pair<double, Proposal>> list;
  for (size_t m = 0; m < estimate.members.size(); ++m) {
    if (!is_law(*estimate.members[m].candidate)) continue;
    for (const Law& law : laws) {
      Swap swap = sum.nearest(law, m);
      if (swap.apart < far_from_grid * most_apart) sum.refine(swap, m);
      if (!(swap.apart < most_apart)) continue;
      if (std::optional<Proposal> proposal = sum.proposal(swap, m))
        list.emplace_back(swap.apart, std::move(*proposal));
    }
  }
  std::ranges::stable_sort(list, {}, &std::pair<double, Proposal>::first);
  std::vector<Proposal> swaps;
  for (auto& [apart, proposal] : list) swaps.push_back(std::move(proposal));
  return swaps;
}

}  // namespace loopwright::diagnosis
