#include "tools/diagnose/search/doubt.h"
#include "models/real/whole.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/derived_identity.h"

namespace loopwright::diagnosis {
namespace {

/// The path with a different, equally plausible estimation error.
Path seen_otherwise(const Path& path, const Pace& pace, double shift_s) {
  Path other = path;
  other.identity = derived_identity(path.identity, std::bit_cast<uint64_t>(shift_s));
  const size_t rows = path.samples(), shift = whole_count(shift_s / path.sample_time);
  const double kept = std::pow(criteria::kept_velocity_error, 1.0 / pace.samples_to_correct);
  double error = 0;
  for (size_t k = 0; k < rows; ++k) {
    const size_t from = (k + rows - shift % rows) % rows;
    const double correction = from == 0 ? 0
                                        : path.velocity[from] - path.velocity[from - 1] -
                                              path.acceleration[from - 1] * path.sample_time;
    error = kept * error + correction;
    other.velocity[k] += criteria::velocity_errors * error;
  }
  return other;
}

/// The force consumed by the members that may be doubtful.
std::vector<double> force_along(std::vector<Member> members, const Path& path) {
  std::erase_if(members, [](const Member& m) { return !m.candidate->flies; });
  return drives_of(members, path, path.input).force;
}

double most_change_of(const Trials& trials) { return criteria::most_doubt * search_noise(trials).white; }

/// Marks the rows at which two forces differ by more than `most`, and the rows after them.
void mark_where_they_differ(const std::vector<double>& one, const std::vector<double>& other, double most,
                            const Pace& pace, std::vector<char>& rows) {
  int left = 0;
  for (size_t k = 0; k < rows.size(); ++k) {
    left = std::abs(other[k] - one[k]) > most ? pace.samples_to_correct : std::max(0, left - 1);
    if (left > 0) rows[k] = 1;
  }
}

/// The force that a candidate consumes at its initial amplitudes.
std::vector<double> force_at_start(const Candidate& candidate, const Columns& columns) {
  std::vector<double> force(columns.front().mean->size());
  for (size_t c = 0; c < columns.size(); ++c)
    for (size_t k = 0; k < force.size(); ++k)
      force[k] += candidate.linear[c].start * double((*columns[c].mean)[k]);
  return force;
}

/// For one candidate. One shift is enough to rank the shapes, and costs half as much as two.
void mark_doubtful(std::span<Shape> shapes, const Trials& trials, const Motion& motion) {
  const Candidate& candidate = *shapes.front().candidate;
  const double most = most_change_of(trials);
  std::vector<std::vector<double>> points;
  for (const Shape& shape : shapes) points.push_back(shape.nonlinear);
  for (size_t t = 0; t < motion.paths.size(); ++t) {
    const Path& path = *motion.paths[t];
    const Pace& pace = trials.list[t].pace;
    for (Shape& shape : shapes) shape.doubtful.emplace_back(path.samples(), char(0));
    const std::vector<Columns> others =
        candidate.columns_at(seen_otherwise(path, pace, criteria::doubt_shifts_s[0]), points);
    for (size_t i = 0; i < shapes.size(); ++i)
      mark_where_they_differ(force_at_start(candidate, shapes[i].columns[t]),
                             force_at_start(candidate, others[i]), most, pace, shapes[i].doubtful[t]);
  }
}

}  // namespace

bool may_be_doubtful(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return m.candidate->flies; });
}

std::vector<std::vector<char>> doubtful_rows(const Trials& trials, const Estimate& estimate) {
  const double most = most_change_of(trials);
  std::vector<std::vector<char>> doubtful;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Path& path = *estimate.motion.paths[t];
    const Pace& pace = trials.list[t].pace;
    std::vector<char>& rows = doubtful.emplace_back(path.samples(), char(0));
    const std::vector<double> force = force_along(estimate.members, path);
    for (const double shift : criteria::doubt_shifts_s)
      mark_where_they_differ(force, force_along(estimate.members, seen_otherwise(path, pace, shift)), most,
                             pace, rows);
  }
  return doubtful;
}

void add_without_doubt(const Trials& trials, const Motion& motion, std::vector<Shape>& shapes) {
  // Away from the blows, whose moment each gap has for itself, the force changes little from one shape of a
  // fine grid to the next.
  constexpr size_t every = 4, fine_grid = 8;
  std::vector<Shape> flying;
  for (size_t i = 0, along_grid = 0; i < shapes.size(); ++i) {
    along_grid = i > 0 && shapes[i].candidate == shapes[i - 1].candidate ? along_grid + 1 : 0;
    if (!shapes[i].candidate->flies) continue;
    const auto points = size_t(std::ranges::count(shapes, shapes[i].candidate, &Shape::candidate));
    if (points < fine_grid || along_grid % every == every / 2) flying.push_back(shapes[i]);
  }
  for (auto first = flying.begin(); first != flying.end();) {
    const auto is_other = [&](const Shape& shape) { return shape.candidate != first->candidate; };
    const auto end = std::find_if(first, flying.end(), is_other);
    mark_doubtful({first, end}, trials, motion);
    first = end;
  }
  std::ranges::move(flying, std::back_inserter(shapes));
}

void leave_out_doubtful(Trials& trials, Estimate& estimate) {
  std::vector<std::vector<char>> usable;
  for (const Trial& trial : trials.list) usable.push_back(trial.certain());
  if (may_be_doubtful(estimate.members)) {
    const std::vector<std::vector<char>> doubtful = doubtful_rows(trials, estimate);
    size_t moving = 0, left = 0;
    for (size_t t = 0; t < doubtful.size(); ++t)
      for (size_t k = 0; k < doubtful[t].size(); ++k) {
        moving += size_t(usable[t][k]);
        if (doubtful[t][k]) usable[t][k] = 0;
        left += size_t(usable[t][k]);
      }
    // A shape that makes nearly all rows doubtful explains nothing.
    if (double(left) < criteria::least_without_doubt * double(moving))
      for (size_t t = 0; t < usable.size(); ++t) usable[t] = trials.list[t].certain();
  }
  bool changes = false;
  for (size_t t = 0; t < usable.size(); ++t) {
    changes |= usable[t] != trials.list[t].usable;
    trials.list[t].usable = std::move(usable[t]);
  }
  if (!changes) return;
  estimate.mean_square = mean_square(trials, *estimate.fitted);
  estimate.profile = profile(trials, *estimate.fitted);
}

}  // namespace loopwright::diagnosis
