/// One period of a plan on hardware: measured numbers in, commands out. Deployment and replay both step by
/// this, and it steps by the very Run that a simulation steps by.
#pragma once
#include "engine/run/run.h"
#include "hw/realtime/axes.h"

namespace loopwright::hw {

class PeriodStepper {
 public:
  PeriodStepper(const Plan& plan, const Hardware& hardware);

  void reset() { run_.reset({run_.plan().seed, 0}); }
  /// What an axis measured.
  void measure(size_t axis, double position, double velocity) noexcept {
    *positions_[axis] = position;
    if (hardware_.axes[axis].io->velocity_channel >= 0) *velocities_[axis] = velocity;
  }
  /// All outputs of this instant; `after(block)` after each of them.
  template <class After> void compute(After&& after) noexcept {
    due_ = run_.due();
    run_.evaluate_watched(due_, after);
    run_.accept();
  }
  double command(size_t axis) const { return run_.number(hardware_.axes[axis].command); }
  /// Memories, and everything between this period and the next; after the commands are out.
  void finish() noexcept;

  const Run<double>& run() const { return run_; }
  bool is_last() const { return run_.now().tick + hardware_.period_ticks > run_.plan().stop_tick; }
  /// Which block stopped the step and why.
  std::string fault() const;

 private:
  const Hardware& hardware_;
  Run<double> run_;
  std::vector<double*> positions_, velocities_;
  uint64_t due_ = 0;
};

}  // namespace loopwright::hw
