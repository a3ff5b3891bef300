/// An effect's blocks on the lanes of a run, and the signals that are given to them.
#pragma once
#include <memory>
#include <span>
#include <vector>
#include "engine/lanes/lane_run.h"
#include "tools/effects/effect_plan.h"
#include "tools/effects/role_signals.h"

namespace loopwright {

inline constexpr double gauss_point = 0.21132486540518712;  // (1 - 1/√3) / 2, as a part of a sample

class EffectLanes {
 public:
  struct Setting {  // a parameter of an ExternalSignal, in every lane
    std::vector<double*> lanes;
    std::vector<std::span<double>> rows;  // the same, as far as they are adjacent
    void set(double to) const;
  };
  struct Wire {
    Setting value, slope, bend, since;
    bool is_read() const { return !value.lanes.empty(); }
  };

  /// The plan must outlive it.
  EffectLanes(const EffectPlan& plan, InstructionSet set, int arenas);

  LaneRun& run() { return *run_; }
  size_t lanes() const { return bound_.size(); }
  int64_t sample_ticks() const { return sample_ticks_; }
  /// Back to rest at the first sample, with these fitted parameters of each set; lane l has those of set
  /// l mod sets.
  void start(const std::vector<std::vector<double>>& fitted, const RoleSample& first);
  /// To all lanes, from an instant [s] on. Anything not set here stays zero.
  void give(const GivenSignals& given, double since);
  /// To one lane, whose instant is set apart.
  void give(const GivenSignals& given, size_t lane);
  void give_since(double since, size_t lane);
  /// Value, and the slope that the blocks state, at an instant [s]: of a sample, at its first Gauss point.
  void read_first(double at);
  /// At the second one: value and slope become the mean over the sample, and the change over it of the
  /// straight line with the same first moment.
  void read_second(double at);
  void read(Number number, std::vector<double>& to) const { run_->read({&number, 1}, to.data()); }

  Wire position, velocity, acceleration, input, force;
  std::vector<double> value, slope, stated_slope;  ///< one per lane

 private:
  template <class Put> void give_by(const GivenSignals& given, Put&& put);
  Wire wire(const char* role);

  const EffectPlan& plan_;
  std::unique_ptr<LaneRun> run_;
  std::vector<std::vector<double*>> bound_;
  int64_t sample_ticks_;
  std::vector<double> second_;
};

}  // namespace loopwright
