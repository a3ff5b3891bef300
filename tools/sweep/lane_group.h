/// Parallel runs of a sweep: the data of one thread, reused from block to block.
#pragma once
#include <memory>
#include "engine/lanes/lane_run.h"
#include "tools/sweep/shard.h"
#include "tools/sweep/sweep_plan.h"

namespace loopwright {

/// A single run, as `loopwright run` makes it.
RunRecord make_alone(const SweepPlan& plan, const LoadOptions& options, int64_t run);

class LaneGroup {
 public:
  LaneGroup(const SweepPlan& plan, std::optional<InstructionSet> set);

  /// The runs [first, end) of one world, with their metrics.
  std::vector<RunRecord> make(int64_t first, int64_t end);

 private:
  void enter(int64_t world);
  void make_on_lanes(int64_t first, int64_t end, std::vector<RunRecord>& records);

  const SweepPlan& plan_;
  InstructionSet set_;
  int64_t world_ = -1;
  std::unique_ptr<LaneRun> run_;
  std::unique_ptr<MetricBank> metrics_;
  std::vector<double*> parameters_;  // [tuned · lanes + lane]
  std::vector<double> values_;
};

}  // namespace loopwright
