/// A record on the lanes of one run, a segment on each.
#pragma once
#include "tools/effects/effect_lanes.h"

namespace loopwright {

/// For an effect that remembers only accepted memory, and forgets it on the way, as dry friction does. Every
/// segment begins some way before its first row with nothing remembered. What it remembers at that row must
/// be, bit for bit, what the segment before it remembers there: then the numbers are those of the whole
/// record in turn. See EffectRun.
class SegmentRun {
 public:
  /// The instruction set of the widest lanes.
  explicit SegmentRun(std::shared_ptr<const EffectPlan> plan);

  /// Mean and slope of every row for these fitted parameters. False if the record is short, or if a segment
  /// remembers something else: run it in turn then.
  bool run(const RoleSignals& signals, size_t rows, const std::vector<double>& fitted,
           std::vector<double>& mean, std::vector<double>& slope);

 private:
  struct Segment {
    size_t start, first, end;                     // rows: where it begins, and those that it keeps
    std::vector<double> remembers_first, at_end;  // by its lane there
  };
  size_t lead(const RoleSignals& signals, size_t row, size_t most) const;
  std::vector<Segment> segments_of(const RoleSignals& signals, size_t rows) const;
  void step(const RoleSignals& signals, size_t rows, const std::vector<Segment>& segments, size_t step);
  bool run_once(const RoleSignals& signals, size_t rows, const std::vector<double>& fitted,
                std::vector<double>& mean, std::vector<double>& slope);

  std::shared_ptr<const EffectPlan> plan_;
  EffectLanes lanes_;
  double way_before_;        // over which a segment is led to its first row, the same for all [stroke]
  int in_turn_ = 0;          // runs for which no segments are tried
  std::vector<double> now_;  // of each lane [s]
};

}  // namespace loopwright
