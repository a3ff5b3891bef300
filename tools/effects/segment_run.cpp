#include "tools/effects/segment_run.h"
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

/// What is remembered fades with the way: at first a segment is led over so much of the stroke to its first
/// row, and over so many times more where that does not suffice; at most about half the stroke. What
/// remembers a longer way is run in turn, and so are some sets of numbers after it: a fit moves them little
/// by little.
constexpr double first_way = 0.002, longest_way = 0.6;  // [stroke]
constexpr double longer = 4;
constexpr int runs_in_turn = 16;
/// On either side, within a quarter of a segment.
constexpr size_t tried_firsts = 8;
/// Rows of a segment below which the beginnings outweigh the rest.
constexpr size_t least_rows = 64;

}  // namespace

SegmentRun::SegmentRun(std::shared_ptr<const EffectPlan> plan)
    : plan_(std::move(plan)),
      lanes_(*plan_, widest_instruction_set(), 1),
      way_before_(first_way),
      now_(lanes_.lanes()) {}

/// How many rows before a row the way is long enough that a segment can begin there; at most `most`.
size_t SegmentRun::lead(const RoleSignals& signals, size_t row, size_t most) const {
  const double long_enough = way_before_ * plan_->sizes.stroke;
  size_t rows = 0;
  for (double way = 0; rows < std::min(row, most) && way < long_enough; ++rows)
    way += std::abs(signals.position[row - rows] - signals.position[row - rows - 1]);
  return rows;
}

/// Nearly equal numbers of rows: the first of each is chosen for a short lead, and so not within a rest.
std::vector<SegmentRun::Segment> SegmentRun::segments_of(const RoleSignals& signals, size_t rows) const {
  const size_t lanes = lanes_.lanes(), each = (rows + lanes - 1) / lanes;
  std::vector<Segment> segments(lanes);
  for (size_t i = 0; i < lanes; ++i) {
    size_t first = std::min(rows, i * each), before = lead(signals, std::min(first, rows - 1), each);
    for (size_t k = 1; k <= tried_firsts && i > 0 && first < rows; ++k)
      for (const int sign : {-1, 1}) {
        const size_t other = i * each + size_t(sign * int(k * each / (4 * tried_firsts)));
        if (other >= rows) continue;
        if (const size_t lead_there = lead(signals, other, before); lead_there < before)
          first = other, before = lead_there;
      }
    segments[i] = {first - before, first, rows, {}, {}};
    if (i > 0) segments[i - 1].end = first;
  }
  return segments;
}

/// A row of every segment; beyond its end a lane stays at the last one.
void SegmentRun::step(const RoleSignals& signals, size_t rows, const std::vector<Segment>& segments,
                      size_t step) {
  const double period = plan_->sizes.sample_time;
  for (size_t i = 0; i < segments.size(); ++i) {
    const size_t row = std::min(segments[i].start + step, rows - 1);
    lanes_.give(signals.at(row).given(period), i);
    now_[i] = plan_->plan.clock.time(int64_t(row) * lanes_.sample_ticks());
  }
  // The clock of the lanes stands at zero, so that each is at an instant of its own. Seconds are those of the
  // whole record in turn, with their rounding.
  const auto at = [&](double part) {
    for (size_t i = 0; i < segments.size(); ++i) lanes_.give_since(now_[i] - (now_[i] + part * period), i);
  };
  at(plan_->acts_on_sensor ? 0 : gauss_point);
  lanes_.read_first(0);
  if (plan_->acts_on_sensor) return;
  at(1 - gauss_point);
  lanes_.read_second(0);
}

bool SegmentRun::run_once(const RoleSignals& signals, size_t rows, const std::vector<double>& fitted,
                          std::vector<double>& mean, std::vector<double>& slope) {
  std::vector<Segment> segments = segments_of(signals, rows);
  size_t steps = 0;
  for (const Segment& s : segments) steps = std::max(steps, s.end - s.start);
  lanes_.start({fitted}, signals.at(0));
  mean.resize(rows), slope.resize(rows);
  for (size_t k = 0; k <= steps; ++k) {
    for (size_t i = 0; i < segments.size(); ++i) {
      Segment& s = segments[i];
      if (s.start + k == s.first) lanes_.run().accepted_memory(int(i), s.remembers_first);
      if (s.start + k == s.end) lanes_.run().accepted_memory(int(i), s.at_end);
    }
    if (k == steps) break;
    step(signals, rows, segments, k);
    for (size_t i = 0; i < segments.size(); ++i) {
      const size_t row = segments[i].start + k;
      if (row < segments[i].first || row >= segments[i].end) continue;
      mean[row] = lanes_.value[i], slope[row] = lanes_.slope[i];
    }
  }
  if (lanes_.run().failed()) return false;
  for (size_t i = 1; i < segments.size(); ++i)
    if (segments[i].first < rows && segments[i].remembers_first != segments[i - 1].at_end) return false;
  return true;
}

bool SegmentRun::run(const RoleSignals& signals, size_t rows, const std::vector<double>& fitted,
                     std::vector<double>& mean, std::vector<double>& slope) {
  if (lanes_.lanes() == 1 || signals.position.size() < rows || rows < least_rows * lanes_.lanes())
    return false;
  if (in_turn_ > 0) return --in_turn_, false;
  for (; way_before_ <= longest_way; way_before_ *= longer)
    if (run_once(signals, rows, fitted, mean, slope)) return true;
  way_before_ = first_way, in_turn_ = runs_in_turn;
  return false;
}

}  // namespace loopwright
