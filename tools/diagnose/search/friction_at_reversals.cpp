#include "tools/diagnose/search/friction_at_reversals.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

bool turns_at(const Path& path, size_t row) {
  return row > 0 && row < path.samples() && (path.velocity[row] > 0) != (path.velocity[row - 1] > 0);
}

/// In motion after the start, and not beside a change of sign.
bool has_certain_sign(const Path& path, const Trial& trial, size_t row) {
  const AxisRecord& record = trial.model->record();
  if (path.rests[row] || trial.at_rest[row] || record.is_missing(row) || record.is_false(row)) return false;
  for (size_t near = row; near <= row + 1 + criteria::rows_of_a_turn; ++near)
    if (near >= criteria::rows_of_a_turn && turns_at(path, near - criteria::rows_of_a_turn)) return false;
  return true;
}

std::vector<char> with_reversals(const Trial& trial, const Path& path) {
  std::vector<char> rows = trial.usable;
  for (size_t k = trial.settled_from; k < std::min(path.samples(), rows.size()); ++k)
    if (has_certain_sign(path, trial, k)) rows[k] = 1;
  return rows;
}

constexpr int iterations_of_a_law = 6;  // fitted to all rows
constexpr size_t tried_shapes_of_a_law = 3;

/// Other rows count as long as it lives.
class OtherRows {
 public:
  OtherRows(Trials& trials, const std::vector<std::vector<char>>& rows) : trials_(trials), before_(rows) {
    exchange();
  }
  ~OtherRows() { exchange(); }
  OtherRows(const OtherRows&) = delete;
  const std::vector<std::vector<char>>& before() const { return before_; }

 private:
  void exchange() {
    for (size_t t = 0; t < before_.size(); ++t) std::swap(trials_.list[t].usable, before_[t]);
  }
  Trials& trials_;
  std::vector<std::vector<char>> before_;
};

/// Other laws of dry friction, if this is one.
std::vector<const Candidate*> other_laws(const Candidate& present, const std::vector<Shape>& shapes,
                                         const std::vector<const Candidate*>& refused) {
  std::vector<const Candidate*> laws;
  for (const Shape& shape : shapes)
    if (is_dry_friction(present) && is_dry_friction(*shape.candidate) &&
        shape.candidate->name != present.name && (laws.empty() || laws.back() != shape.candidate) &&
        !is_among(refused, *shape.candidate))
      laws.push_back(shape.candidate);
  return laws;
}

/// Friction that falls with speed contains dry friction, and takes up what a step makes of the first rows
/// after a turn: it is declared. So only what builds up over a distance, or has no more parameters, replaces.
bool may_replace(const Candidate& law, const Candidate& present) {
  return law.at_rest == AtRest::gives || parameters_of(law) <= parameters_of(present);
}

/// A law in place of a member: its first amplitude is the level.
std::vector<Member> exchanged(std::vector<Member> members, size_t at, const Candidate& law,
                              std::vector<double> nonlinear) {
  std::vector<double> linear(law.linear.size(), 0.0);
  linear.front() = members[at].linear.front();
  members[at] = {&law, std::move(linear), std::move(nonlinear)};
  return members;
}

}  // namespace

FrictionAtReversals::FrictionAtReversals(Trials& trials, const Estimate& estimate,
                                         const std::vector<Shape>& shapes, size_t catalogue,
                                         const std::vector<const Candidate*>& refused)
    : trials_(trials), estimate_(estimate), shapes_(shapes), catalogue_(catalogue), refused_(refused) {
  const auto is_dry_member = [](const Member& m) { return is_dry_friction(*m.candidate); };
  if (trials.has_map() || std::ranges::none_of(estimate.members, is_dry_member)) return;
  for (size_t t = 0; t < trials.list.size(); ++t)
    rows_.push_back(with_reversals(trials.list[t], (*estimate.fitted)[t].prediction.path));
  for (size_t t = 0; t < rows_.size(); ++t)
    for (size_t k = 0; k < trials.list[t].held_out_from; ++k)
      after_reversals_ += rows_[t][k] > trials.list[t].usable[k];
  if (after_reversals_ > 0) present_ = on_all_rows(estimate.members, 4), exclude_none();
}

FrictionAtReversals::Rows FrictionAtReversals::on_all_rows(const std::vector<Member>& members,
                                                           int iterations) {
  const OtherRows counted(trials_, rows_);
  Rows rows{fit_members(trials_, members, estimate_.noise, estimate_.motion, iterations), 0, {}};
  if (!rows.fitted.is_valid) return rows;
  const size_t ports = trials_.ports();
  for (size_t t = 0; t < rows_.size(); ++t)
    for (size_t k = 0, last = 0; k < trials_.list[t].held_out_from; ++k) {
      if (!(rows_[t][k] > counted.before()[t][k])) continue;
      if (rows.squares.empty() || k > last + 2 + 2 * criteria::rows_of_a_turn) rows.squares.push_back(0);
      for (size_t p = 0; p < ports; ++p)
        rows.squares.back() += std::pow((*rows.fitted.fitted)[t].white[k * ports + p], 2);
      last = k;
    }
  for (double squares : rows.squares) rows.mean_square += squares / double(after_reversals_ * ports);
  return rows;
}

/// The best shapes of a law in the place of a member, according to all rows.
std::vector<std::vector<double>> FrictionAtReversals::best_shapes(size_t member, const Candidate& law) {
  const OtherRows counted(trials_, rows_);
  std::vector<const Shape*> of_law;
  for (const Shape& shape : shapes_)
    if (shape.candidate == &law) of_law.push_back(&shape);
  const Evidence evidence(trials_, present_.fitted, of_law, catalogue_, std::numeric_limits<size_t>::max());
  std::vector<std::vector<double>> best;
  for (const Proposal& proposal : evidence.each_shape({member}))
    if (best.size() < tried_shapes_of_a_law) best.push_back(proposal.added.front().nonlinear);
  return best;
}

FrictionAtReversals::Rows FrictionAtReversals::with_law(size_t member, const Candidate& law) {
  Rows best;
  for (const std::vector<double>& shape : best_shapes(member, law)) {
    Rows rows = on_all_rows(exchanged(estimate_.members, member, law, shape), 1);
    if (rows.fitted.is_valid && (!best.fitted.is_valid || rows.fitted.profile < best.fitted.profile))
      best = std::move(rows);
  }
  return best.fitted.is_valid ? on_all_rows(best.fitted.members, iterations_of_a_law) : best;
}

/// A fall within a few speeds at which the axis counts as at rest is what a step makes of a turn.
bool FrictionAtReversals::is_resolved(const Member& law) const {
  const double least = criteria::rest_speeds_of_a_fall * trials_.list.front().pace.rest_speed;
  return !is_dry_friction(*law.candidate) || law.candidate->at_rest != AtRest::holds ||
         law.nonlinear.empty() || law.nonlinear[0] > least;
}

double FrictionAtReversals::gain(const Rows& from, const Rows& to) const {
  const OtherRows counted(trials_, rows_);
  return criterion(trials_, from.fitted, catalogue_) - criterion(trials_, to.fitted, catalogue_);
}

/// Not because of a single reversal.
bool FrictionAtReversals::explains(const Rows& one, const Rows& other, double least_gain) const {
  if (!one.fitted.is_valid || !other.fitted.is_valid || one.squares.size() != other.squares.size())
    return false;
  if (one.mean_square > criteria::most_mean_square_at_reversals) return false;
  const double gained = gain(other, one);
  double most = 0, all = 0;
  for (size_t i = 0; i < one.squares.size(); ++i) {
    const double here = other.squares[i] - one.squares[i];
    most = std::max(most, here), all += here;
  }
  return gained > least_gain && (all <= 0 || all - most > 0);
}

void FrictionAtReversals::exclude_none() {
  const double fitted = double(fitted_numbers(trials_)) / double(trials_.ports());
  const bool is_hidden = double(after_reversals_) > criteria::most_hidden_at_turns * fitted;
  if (!is_hidden || present_.mean_square <= criteria::most_mean_square_at_reversals) return;
  for (size_t m = 0; m < estimate_.members.size(); ++m) {
    const Candidate& present = *estimate_.members[m].candidate;
    if (present.at_rest != AtRest::holds) continue;
    for (const Candidate* law : other_laws(present, shapes_, refused_))
      if (law->at_rest == AtRest::holds && parameters_of(*law) > parameters_of(present))
        not_excluded_.push_back({m, law});
  }
}

std::optional<Estimate> FrictionAtReversals::better() {
  const double numbers = double(after_reversals_ * trials_.ports());
  if (numbers * (present_.mean_square - 1) < criteria::least_gain) return {};
  Rows best;
  for (size_t m = 0; m < estimate_.members.size(); ++m)
    for (const Candidate* law : other_laws(*estimate_.members[m].candidate, shapes_, refused_)) {
      Rows rows = with_law(m, *law);
      if (!explains(rows, present_, criteria::least_gain) || !is_resolved(rows.fitted.members[m])) continue;
      const bool is_beyond_doubt = gain(present_, rows) > criteria::least_gain_at_reversals &&
                                   may_replace(*law, *estimate_.members[m].candidate);
      if (!is_beyond_doubt || is_at_limit(rows.fitted.members[m]))
        not_excluded_.push_back({m, law});
      else if (!best.fitted.is_valid || gain(best, rows) > 0)
        best = std::move(rows);
    }
  if (!best.fitted.is_valid) return {};
  for (size_t t = 0; t < rows_.size(); ++t)
    trials_.list[t].with_reversals = trials_.list[t].usable = rows_[t];
  after_reversals_ = 0;
  return std::move(best.fitted);
}

bool FrictionAtReversals::is_refuted(size_t member, const Candidate& law, const Estimate& other) {
  const Candidate& present = *estimate_.members[member].candidate;
  if (after_reversals_ == 0 || !is_dry_friction(present) || !is_dry_friction(law)) return false;
  if (present_.mean_square > criteria::most_mean_square_at_reversals) return false;
  return other.is_valid && explains(present_, on_all_rows(other.members, iterations_of_a_law),
                                    criteria::least_gain_at_reversals);
}

bool forget_reversals(Trials& trials) {
  bool changes = false;
  for (Trial& trial : trials.list) {
    if (trial.with_reversals.empty()) continue;
    trial.with_reversals.clear(), trial.usable = trial.moving, changes = true;
  }
  return changes;
}

}  // namespace loopwright::diagnosis
