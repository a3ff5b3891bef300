#include "tools/diagnose/search/evidence.h"
#include <algorithm>
#include <cmath>
#include "models/statistics/information_criterion.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/in_parallel.h"
#include "tools/diagnose/search/remembered_runs.h"

namespace loopwright::diagnosis {
namespace {

/// Every combination of the grids.
std::vector<std::vector<double>> grid_points(const Candidate& candidate) {
  std::vector<std::vector<double>> points{{}};
  for (const CandidateParameter& parameter : candidate.nonlinear) {
    std::vector<std::vector<double>> longer;
    for (const auto& point : points)
      for (double value : parameter.grid) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

bool is_feasible(const Shape& shape, const Eigen::VectorXd& theta, Eigen::Index first) {
  const Candidate& candidate = *shape.candidate;
  if (candidate.amplitude_is_one)
    return theta[first] > criteria::least_step_to_shape && theta[first] < criteria::most_step_to_shape;
  for (size_t i = 0; i < candidate.linear.size(); ++i) {
    const double value = theta[first + Eigen::Index(i)];
    if (!(value >= candidate.linear[i].low && value <= candidate.linear[i].high)) return false;  // nor NaN
  }
  return true;
}

/// Two functions without a name of the same variables take each other's part.
bool state_one_function(const Candidate& one, const Candidate& other) {
  return one.is_unknown && other.is_unknown && one.form == other.form;
}

}  // namespace

bool is_far(const std::vector<double>& shape, const std::vector<double>& other) {
  for (size_t i = 0; i < shape.size(); ++i) {
    const double ratio = std::abs(shape[i] / other[i]);
    if (!(ratio < criteria::other_shape && ratio > 1 / criteria::other_shape)) return true;
  }
  return false;
}

double left_by(double squares, double of) { return std::max(squares, 1e-12 * of); }

size_t parameters_of(const Candidate& candidate) {
  return (candidate.amplitude_is_one ? 0 : candidate.linear.size()) + candidate.nonlinear.size();
}

double criterion(const Trials& trials, const Estimate& estimate, size_t catalogue) {
  const double n = double(fitted_numbers(trials));
  size_t parameters = 0;
  for (const Member& member : estimate.members) parameters += parameters_of(*member.candidate);
  return estimate.profile + estimate.against_at_rest +
         extended_bayesian_price(parameters, estimate.members.size(), n, catalogue);
}

std::vector<Member> applied(const Proposal& proposal, std::vector<Member> members) {
  for (size_t i = proposal.removed.size(); i-- > 0;)
    members.erase(members.begin() + std::ptrdiff_t(proposal.removed[i]));
  const std::vector<FreeParameter> free = free_parameters(members);
  double fraction = 1;  // all together, up to the first end of a range; what is at its end stays there
  for (size_t i = 0; i < free.size(); ++i) {
    const CandidateParameter& range = range_of(members, free[i]);
    const double value = value_of(members, free[i]), step = proposal.step[i];
    const double room = step > 0 ? range.high - value : value - range.low;
    if (room > 0 && std::abs(step) > room) fraction = std::min(fraction, room / std::abs(step));
  }
  for (size_t i = 0; i < free.size(); ++i) {
    const CandidateParameter& range = range_of(members, free[i]);
    double& value = value_of(members, free[i]);
    value = std::clamp(value + fraction * proposal.step[i], range.low, range.high);
  }
  for (Member member : proposal.added) {
    if (!member.candidate->amplitude_is_one)
      for (double& amplitude : member.linear) amplitude *= fraction;
    members.push_back(std::move(member));
  }
  return members;
}

void add_shapes(const Candidate& candidate, const std::vector<std::vector<double>>& points,
                const Motion& motion, std::vector<Shape>& shapes) {
  const size_t first = shapes.size();
  for (const auto& point : points) shapes.push_back({&candidate, point, {}, {}});
  for (const auto& path : motion.paths) {
    std::vector<Columns> columns = candidate.columns_at(*path, points);
    for (size_t i = 0; i < points.size(); ++i) shapes[first + i].columns.push_back(std::move(columns[i]));
  }
}

std::vector<Shape> shapes_of(const std::vector<Candidate>& candidates, const Motion& motion) {
  std::vector<std::vector<Shape>> of_each(candidates.size());
  in_parallel(candidates.size(), [&](size_t i) {
    if (candidates[i].has_grid()) add_shapes(candidates[i], grid_points(candidates[i]), motion, of_each[i]);
  });
  std::vector<Shape> shapes;
  for (std::vector<Shape>& some : of_each) std::ranges::move(some, std::back_inserter(shapes));
  return shapes;
}

Evidence::Evidence(const Trials& trials, const Estimate& estimate, const std::vector<const Shape*>& shapes,
                   size_t catalogue, size_t most_rows)
    : members_(estimate.members),
      shapes_(shapes),
      catalogue_(catalogue),
      free_(free_parameters(estimate.members)) {
  Eigen::Index width = Eigen::Index(free_.size());
  for (const Shape* shape : shapes)
    first_column_.push_back(int(width)), width += Eigen::Index(shape->columns[0].size());
  const size_t ports = trials.ports();
  const size_t stride = std::max<size_t>(1, fitted_numbers(trials) / ports / most_rows);
  std::vector<std::vector<size_t>> rows;
  size_t count = 0;
  for (const Trial& trial : trials.list) {
    rows.emplace_back();
    for (size_t k = 0, usable = 0; k < trial.held_out_from; ++k)
      if (trial.usable[k] && usable++ % stride == 0) rows.back().push_back(k);
    count += rows.back().size() * ports;
  }
  n_ = double(count);
  X_.resize(Eigen::Index(count), width + 1);
  Eigen::Index top = 0;
  const auto sensitivities =
      trials.remembered->sensitivities(trials, members_, estimate.motion, estimate.fitted);
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Fitted& fitted = (*estimate.fitted)[t];
    const Path& path = *estimate.motion.paths[t];
    const auto fill = [&](Eigen::Index column, const std::vector<double>& values) {
      Eigen::Index r = top;
      for (size_t k : rows[t])
        for (size_t p = 0; p < ports; ++p) X_(r++, column) = values[k * ports + p];
    };
    const Sensitivity& own = (*sensitivities)[t];
    trials.work->add(path.samples(), double(width) * Work::of_a_response);
    trials.work->add(rows[t].size() * ports, double(width * Eigen::Index(free_.size())) * Work::of_a_product);
    for (size_t c = 0; c < own.columns.size(); ++c) fill(Eigen::Index(c), own.columns[c]);
    for (const Acts acts : {Acts::force, Acts::input, Acts::sensor}) {
      std::vector<const Column*> columns;
      std::vector<double*> places;
      for (size_t s = 0; s < shapes.size(); ++s) {
        if (shapes[s]->candidate->acts != acts || without_doubt(s) != s) continue;
        for (size_t c = 0; c < shapes[s]->columns[t].size(); ++c)
          columns.push_back(&shapes[s]->columns[t][c]),
              places.push_back(X_.data() + X_.rows() * (first_column_[s] + int(c)) + top);
      }
      responses(fitted.axis, fitted.gains, path, acts, columns, rows[t], places);
    }
    for (size_t s = 0; s < shapes.size(); ++s)
      if (!shapes[s]->doubtful.empty()) clear_doubtful(s, shapes[s]->doubtful[t], rows[t], top, ports);
    fill(width, fitted.white);
    top += Eigen::Index(rows[t].size() * ports);
  }
  G_ = Eigen::MatrixXd::Zero(width, width);
  const Eigen::Index own = Eigen::Index(free_.size());
  G_.topRows(own).noalias() = X_.leftCols(own).transpose() * X_.leftCols(width);
  G_.leftCols(own) = G_.topRows(own).transpose().eval();
  for (size_t s = 0; s < shapes.size(); ++s) multiply(s, s);
  b_ = X_.leftCols(width).transpose() * X_.col(width);
  squares_ = X_.col(width).squaredNorm();
  explained_ = left_by(solve(G_, member_columns(), b_, squares_).squares, squares_);
}

/// The same shape with all its rows, which has the same responses; if there is none, the shape itself.
size_t Evidence::without_doubt(size_t shape) const {
  const Shape& s = *shapes_[shape];
  if (s.doubtful.empty()) return shape;
  const auto original = std::ranges::find_if(shapes_, [&](const Shape* other) {
    return other->candidate == s.candidate && other->doubtful.empty() && other->nonlinear == s.nonlinear;
  });
  return original == shapes_.end() ? shape : size_t(original - shapes_.begin());
}

void Evidence::clear_doubtful(size_t shape, const std::vector<char>& doubtful,
                              const std::vector<size_t>& rows, Eigen::Index top, size_t ports) {
  const auto columns = [&](size_t s) {
    return X_.block(top, first_column_[s], Eigen::Index(rows.size() * ports), width_of(s));
  };
  if (const size_t original = without_doubt(shape); original != shape) columns(shape) = columns(original);
  for (size_t i = 0; i < rows.size(); ++i)
    if (doubtful[rows[i]]) columns(shape).middleRows(Eigen::Index(i * ports), Eigen::Index(ports)).setZero();
}

void Evidence::multiply(size_t shape, size_t other) {
  const int i = first_column_[shape], j = first_column_[other];
  G_.block(i, j, width_of(shape), width_of(other)).noalias() =
      X_.middleCols(i, width_of(shape)).transpose() * X_.middleCols(j, width_of(other));
  G_.block(j, i, width_of(other), width_of(shape)) =
      G_.block(i, j, width_of(shape), width_of(other)).transpose().eval();
}

std::vector<int> Evidence::member_columns(const std::vector<size_t>& without, bool only_linear) const {
  std::vector<int> columns;
  for (size_t i = 0; i < free_.size(); ++i)
    if (std::ranges::find(without, free_[i].member) == without.end() && (free_[i].is_linear || !only_linear))
      columns.push_back(int(i));
  return columns;
}

/// What a member explains becomes part of the errors again. A shape that is not proportional to a parameter
/// (a delay) counts as its derivative times its value.
Evidence::Errors Evidence::errors_without(const std::vector<size_t>& removed) const {
  const Eigen::Index own = Eigen::Index(free_.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(own);
  for (size_t i = 0; i < free_.size(); ++i) {
    const FreeParameter& p = free_[i];
    if (std::ranges::find(removed, p.member) == removed.end()) continue;
    const Member& m = members_[p.member];
    if (p.is_linear)
      theta[Eigen::Index(i)] = m.linear[p.index];
    else if (m.candidate->amplitude_is_one)
      theta[Eigen::Index(i)] = m.nonlinear[p.index];
  }
  const Eigen::VectorXd added = G_.leftCols(own) * theta, b = b_ + added;
  const double squares = squares_ + 2 * theta.dot(b_.head(own)) + theta.dot(added.head(own));
  return {removed, b, squares, solve(G_, member_columns(removed), b, squares),
          solve(G_, member_columns(removed, true), b, squares)};
}

/// A candidate is a member only once; one that repeats along the axis may be added again at another pitch. In
/// the place of itself it may take another shape, which a fit does not reach: a resonance at another
/// frequency.
bool Evidence::may_be_added(const Shape& shape, const std::vector<size_t>& removed) const {
  for (size_t m = 0; m < members_.size(); ++m) {
    const Member& member = members_[m];
    const bool is_removed = std::ranges::find(removed, m) != removed.end();
    if (!is_removed && state_one_function(*member.candidate, *shape.candidate)) return false;
    if (member.candidate != shape.candidate) continue;
    const bool other_pitch = shape.candidate->is_periodic && shape.candidate->is_repeatable &&
                             std::abs(shape.nonlinear[0] / member.nonlinear[0] - 1) > 0.02;
    const bool is_near = shape.candidate->has_grid() && !is_far(shape.nonlinear, member.nonlinear);
    if (is_removed ? shape.candidate->is_periodic || is_near : !other_pitch) return false;
  }
  return true;
}

std::vector<int> Evidence::columns_of(const std::vector<size_t>& shapes) const {
  std::vector<int> columns;
  for (size_t s : shapes)
    for (int c = 0; c < width_of(s); ++c) columns.push_back(first_column_[s] + c);
  return columns;
}

/// What the shapes save together with all parameters of the members that stay; empty: not within their
/// ranges.
std::optional<double> Evidence::gain_of(const std::vector<size_t>& shapes, const Errors& errors,
                                        double n) const {
  const Added added = add(G_, columns_of(shapes), errors.members, errors.b);
  Eigen::Index first = 0;
  double cost = 0;
  for (size_t s : shapes) {
    if (!is_feasible(*shapes_[s], added.theta, first)) return {};
    first += width_of(s);
    cost += extended_bayesian_price(parameters_of(*shapes_[s]->candidate), 1, n, catalogue_);
  }
  for (size_t m : errors.removed)
    cost -= extended_bayesian_price(parameters_of(*members_[m].candidate), 1, n, catalogue_);
  return n * std::log(explained_ / left_by(added.squares, errors.squares)) - cost;
}

/// Of all parameters of the members that stay, from the step of their amplitudes.
std::vector<double> Evidence::step_of(const std::vector<size_t>& removed,
                                      const Eigen::VectorXd& amplitudes) const {
  std::vector<double> step;
  Eigen::Index next = 0;
  for (const FreeParameter& p : free_)
    if (std::ranges::find(removed, p.member) == removed.end())
      step.push_back(p.is_linear ? amplitudes[next++] : 0);
  return step;
}

/// The step of the linear parameters of the members that stay, and of the shapes: if the members' shapes are
/// poorly determined, the full step would leave the linear range.
Proposal Evidence::with_step(const std::vector<size_t>& shapes, const Errors& errors, double gain) const {
  const Added added = add(G_, columns_of(shapes), errors.amplitudes, errors.b);
  Proposal proposal{errors.removed, {}, step_of(errors.removed, added.before), gain};
  Eigen::Index next = 0;
  for (size_t s : shapes) {
    const Shape& shape = *shapes_[s];
    Member member{shape.candidate, {}, shape.nonlinear};
    for (int c = 0; c < width_of(s); ++c, ++next)
      member.linear.push_back(shape.candidate->amplitude_is_one ? 1 : added.theta[next]);
    proposal.added.push_back(std::move(member));
  }
  return proposal;
}

/// For every candidate that is not a member, the shape that saves most.
std::vector<Evidence::Promise> Evidence::best_shapes(const Errors& errors, double n) const {
  std::vector<Promise> best;
  for (size_t s = 0; s < shapes_.size(); ++s) {
    if (!may_be_added(*shapes_[s], errors.removed)) continue;
    const auto gain = gain_of({s}, errors, n);
    if (!gain) continue;
    const auto same = std::ranges::find(best, shapes_[s]->candidate,
                                        [&](const Promise& p) { return shapes_[p.shape]->candidate; });
    if (same == best.end())
      best.push_back({s, *gain});
    else if (*gain > same->gain)
      *same = {s, *gain};
  }
  return best;
}

std::vector<Proposal> Evidence::extensions(double n) const {
  std::vector<Proposal> list;
  const Errors errors = errors_without({});
  for (const auto [shape, gain] : best_shapes(errors, n))
    if (gain > 0) list.push_back(with_step({shape}, errors, gain));
  std::ranges::stable_sort(list, std::ranges::greater{}, &Proposal::gain);
  return list;
}

std::optional<Proposal> Evidence::best_pair(bool one_without_name) {
  const Errors errors = errors_without({});
  const std::vector<Promise> best = best_shapes(errors, n_);
  const auto nameless = [&](size_t shape) { return int(shapes_[shape]->candidate->is_unknown); };
  std::vector<size_t> pair;
  double most = 0;
  for (size_t i = 0; i < best.size(); ++i)
    for (size_t j = i + 1; j < best.size(); ++j) {
      const size_t one = best[i].shape, other = best[j].shape;
      if (nameless(one) + nameless(other) != int(one_without_name)) continue;
      multiply(one, other);
      if (const auto gain = gain_of({one, other}, errors, n_); gain && *gain > most)
        most = *gain, pair = {one, other};
    }
  return pair.empty() ? std::nullopt : std::optional(with_step(pair, errors, most));
}

std::vector<std::vector<size_t>> Evidence::removals() const {
  std::vector<std::vector<size_t>> list;
  for (size_t i = 0; i < members_.size(); ++i) {
    list.push_back({i});
    for (size_t j = i + 1; j < members_.size(); ++j) list.push_back({i, j});
  }
  return list;
}

std::vector<Proposal> Evidence::exchanges() const {
  std::vector<Proposal> list;
  for (const auto& removed : removals()) {
    const Errors errors = errors_without(removed);
    for (const auto [shape, gain] : best_shapes(errors, n_)) list.push_back(with_step({shape}, errors, gain));
  }
  std::ranges::stable_sort(list, std::ranges::greater{}, &Proposal::gain);
  return list;
}

std::vector<Proposal> Evidence::exchanges_for_pairs() {
  std::vector<Proposal> list;
  for (const auto& removed : removals()) {
    const Errors errors = errors_without(removed);
    const std::vector<Promise> best = best_shapes(errors, n_);
    for (size_t i = 0; i < best.size(); ++i)
      for (size_t j = i + 1; j < best.size(); ++j) {
        const std::vector<size_t> pair{best[i].shape, best[j].shape};
        multiply(pair[0], pair[1]);
        const auto gain = gain_of(pair, errors, n_);
        if (gain && *gain > std::max(best[i].gain, best[j].gain))
          list.push_back(with_step(pair, errors, *gain));
      }
  }
  std::ranges::stable_sort(list, std::ranges::greater{}, &Proposal::gain);
  return list;
}

std::vector<double> Evidence::gains_of_removal(double n) const {
  std::vector<double> gains;
  for (size_t m = 0; m < members_.size(); ++m) {
    const Errors errors = errors_without({m});
    const double without = left_by(errors.members.squares, errors.squares);
    gains.push_back(extended_bayesian_price(parameters_of(*members_[m].candidate), 1, n, catalogue_) -
                    n * std::log(without / explained_));
  }
  return gains;
}

}  // namespace loopwright::diagnosis
