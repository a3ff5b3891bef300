/// Evidence for several shapes at once.
#include <algorithm>
#include <map>
#include <set>
#include "models/statistics/information_criterion.h"
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {
namespace {

/// Sets from which those of the next size are made: so many sets of candidates, with so many shapes of each.
constexpr size_t kept_sets = 40, kept_shapes_of_each = 3;
/// How far outside two points of a grid a shape may lie, in their distance.
constexpr double outside_points = 0.5;
/// [of its squares] Two columns that differ by less are one: an amplitude whose column no shape changes.
constexpr double same_column = 1e-9;

bool is_within(const CandidateParameter& range, double value) {
  return value >= range.low && value <= range.high;
}

}  // namespace

/// A candidate at a point of its grid, or between that and the next one: what lies there is nearly a sum of
/// both.
struct Evidence::Piece {
  size_t shape;
  bool has_next;
  std::vector<int> columns;     ///< of all amplitudes at the point, and of some of them at the next one
  std::vector<size_t> at_next;  ///< those amplitudes

  double weight_of(size_t amplitude, const Products& G) const {
    return std::sqrt(G(columns[amplitude], columns[amplitude]));
  }
};

void Evidence::multiply_all() {
  const Eigen::Index own = Eigen::Index(free_.size()), width = G_.cols() - own;
  G_.bottomRightCorner(width, width).noalias() =
      X_.middleCols(own, width).transpose() * X_.middleCols(own, width);
}

std::vector<Evidence::Piece> Evidence::pieces() const {
  std::vector<Piece> list;
  for (size_t s = 0; s < shapes_.size(); ++s) {
    const auto is_same = [&](size_t other) {
      return other < shapes_.size() && shapes_[other]->candidate == shapes_[s]->candidate;
    };
    const bool has_next = is_same(s + 1);
    if (!has_next && is_same(s - 1)) continue;  // the last point
    Piece piece{s, has_next, columns_of({s}), {}};
    for (size_t i = 0; has_next && i < size_t(width_of(s)); ++i) {
      const int here = first_column_[s] + int(i), there = first_column_[s + 1] + int(i);
      if (G_(here, here) - 2 * G_(here, there) + G_(there, there) <= same_column * G_(here, here)) continue;
      piece.columns.push_back(there), piece.at_next.push_back(i);
    }
    list.push_back(std::move(piece));
  }
  return list;
}

/// The member that amplitudes of the columns of a piece make up; empty: a parameter is outside its range.
std::optional<Member> Evidence::member_of(const Piece& piece, const double* theta) const {
  const Candidate& candidate = *shapes_[piece.shape]->candidate;
  const size_t width = candidate.linear.size();
  Member member{&candidate, {theta, theta + width}, shapes_[piece.shape]->nonlinear};
  double share = 0, most = 0;  // of the next point, by the amplitude that does most
  for (size_t n = 0; n < piece.at_next.size(); ++n) {
    double& amplitude = member.linear[piece.at_next[n]];
    amplitude += theta[width + n];
    const double weight = std::abs(amplitude) * piece.weight_of(piece.at_next[n], G_);
    if (weight > most) most = weight, share = theta[width + n] / amplitude;
  }
  if (!(share >= -outside_points && share <= 1 + outside_points)) return {};
  if (piece.has_next) {
    const CandidateParameter& range = candidate.nonlinear.front();
    const double from = member.nonlinear.front(), to = shapes_[piece.shape + 1]->nonlinear.front();
    const double value = range.logarithmic ? from * std::pow(to / from, share) : std::lerp(from, to, share);
    member.nonlinear.front() = std::clamp(value, range.low, range.high);
  }
  for (size_t i = 0; i < width; ++i)
    if (!is_within(candidate.linear[i], member.linear[i])) return {};
  return member;
}

/// What a set saves; empty: a parameter is outside its range.
std::optional<Proposal> Evidence::proposal_of(const std::vector<const Piece*>& set, const Errors& errors,
                                              double n) const {
  std::vector<int> columns;
  double cost = 0;
  for (const Piece* piece : set) {
    std::ranges::copy(piece->columns, std::back_inserter(columns));
    cost += extended_bayesian_price(parameters_of(*shapes_[piece->shape]->candidate), 1, n, catalogue_);
  }
  for (size_t m : errors.removed)
    cost -= extended_bayesian_price(parameters_of(*members_[m].candidate), 1, n, catalogue_);
  const double squares = add(G_, columns, errors.members, errors.b).squares;
  const Added added = add(G_, columns, errors.amplitudes, errors.b);
  Proposal proposal{errors.removed,
                    {},
                    step_within_ranges(errors.removed, added.before),
                    n * std::log(explained_ / left_by(squares, errors.squares)) - cost};
  const double* theta = added.theta.data();
  for (const Piece* piece : set) {
    std::optional<Member> member = member_of(*piece, theta);
    if (!member) return {};
    proposal.added.push_back(std::move(*member));
    theta += piece->columns.size();
  }
  return proposal;
}

std::vector<double> Evidence::step_within_ranges(const std::vector<size_t>& removed,
                                                 const Eigen::VectorXd& amplitudes) const {
  std::vector<double> step = step_of(removed, amplitudes);
  std::vector<Member> members = members_;
  size_t next = 0;
  for (const FreeParameter& p : free_) {
    if (std::ranges::find(removed, p.member) != removed.end()) continue;
    const CandidateParameter& range = range_of(members, p);
    const double value = value_of(members, p);
    step[next] = std::clamp(value + step[next], range.low, range.high) - value;
    ++next;
  }
  return step;
}

namespace {

/// The candidates of a set, in one order.
std::vector<const Candidate*> candidates_of(const std::vector<Member>& members) {
  std::vector<const Candidate*> list;
  for (const Member& member : members) list.push_back(member.candidate);
  std::ranges::sort(list);
  return list;
}

}  // namespace

/// Whether they are other candidates than those that are removed and more, or the same with other shapes.
bool Evidence::is_another(const std::vector<Member>& added, const std::vector<size_t>& removed) const {
  std::vector<Member> present;
  for (size_t m : removed) present.push_back(members_[m]);
  const auto before = candidates_of(present), now = candidates_of(added);
  if (before != now) return !std::ranges::includes(now, before);
  return std::ranges::any_of(added, [&](const Member& member) {
    const auto same = std::ranges::find(present, member.candidate, &Member::candidate);
    return is_far(member.nonlinear, same->nonlinear);
  });
}

struct Evidence::Set {
  std::vector<const Piece*> pieces;  ///< ascending
  Proposal proposal;
};

/// Sets with one piece more, of another candidate, best first.
std::vector<Evidence::Set> Evidence::extended(const std::vector<Set>& sets, const std::vector<Piece>& all,
                                              const Errors& errors, double n) const {
  std::vector<Set> result;
  std::set<std::vector<const Piece*>> seen;
  for (const Set& set : sets)
    for (const Piece& added : all) {
      const auto is_same = [&](const Piece* p) {
        return shapes_[p->shape]->candidate == shapes_[added.shape]->candidate;
      };
      if (std::ranges::any_of(set.pieces, is_same)) continue;
      std::vector<const Piece*> pieces = set.pieces;
      pieces.insert(std::ranges::upper_bound(pieces, &added), &added);
      if (!seen.insert(pieces).second) continue;
      if (std::optional<Proposal> proposal = proposal_of(pieces, errors, n))
        result.push_back({std::move(pieces), std::move(*proposal)});
    }
  std::ranges::stable_sort(result, std::ranges::greater{}, [](const Set& s) { return s.proposal.gain; });
  return result;
}

std::vector<Proposal> Evidence::sets(const std::vector<size_t>& removed, size_t most, double n,
                                     double most_loss) {
  multiply_all();
  const Errors errors = errors_without(removed);
  const std::vector<Piece> all = pieces();
  std::vector<Proposal> list;
  std::set<std::vector<const Candidate*>> told;
  std::vector<Set> last{{}};
  for (size_t size = 0; size < most; ++size) {
    std::vector<Set> next = extended(last, all, errors, n);
    last.clear();
    std::map<std::vector<const Candidate*>, size_t> kept;
    for (Set& set : next) {
      const auto candidates = candidates_of(set.proposal.added);
      if (kept.size() >= kept_sets && !kept.contains(candidates)) continue;
      if (set.proposal.gain > -most_loss && is_another(set.proposal.added, removed) &&
          told.insert(candidates).second)
        list.push_back(set.proposal);
      if (kept[candidates]++ < kept_shapes_of_each) last.push_back(std::move(set));
    }
  }
  std::ranges::stable_sort(list, std::ranges::greater{}, &Proposal::gain);
  return list;
}

std::vector<Proposal> Evidence::each_shape(const std::vector<size_t>& removed) const {
  std::vector<Proposal> list;
  const Errors errors = errors_without(removed);
  for (size_t s = 0; s < shapes_.size(); ++s)
    if (may_be_added(*shapes_[s], removed))
      if (const auto gain = gain_of({s}, errors, n_)) list.push_back(with_step({s}, errors, *gain));
  std::ranges::stable_sort(list, std::ranges::greater{}, &Proposal::gain);
  return list;
}

}  // namespace loopwright::diagnosis
