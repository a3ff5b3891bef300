/// One period of a plan on hardware: measured numbers in, commands out. Deployment and replay both use it,
/// and it uses the same Run as a simulation.
///
/// Model time is the number of the sample. If samples are missing, the plan is stepped through every instant
/// without one as soon as the next sample has arrived. So references and counters keep time, slower rates
/// keep their phase, and differences are taken over one period. The measurements at those instants are
/// interpolated between the samples before and after, or held with `"on_lost": "hold"`. Commands computed for
/// those instants are not sent: the device held the previous one.
#pragma once
#include "engine/run/run.h"
#include "hw/realtime/axes.h"

namespace loopwright::hw {

class PeriodStepper {
 public:
  PeriodStepper(const Plan& plan, const Hardware& hardware);

  void reset();
  /// The measurement of an axis at the instant of the next compute().
  void measure(size_t axis, double position, double velocity) noexcept {
    measured_[axis] = {position, velocity};
  }
  /// Computes all outputs of this instant; calls `after(block)` after each block. `missing` instants without
  /// a sample came before it. A failed step ends it: see run().failed().
  template <class After> void compute(int64_t missing, After&& after) noexcept {
    for (int64_t i = 1; i <= missing; ++i) {
      set_between(double(i) / double(missing + 1));
      evaluate(after);
      if (run_.failed()) return;
      finish();
    }
    set_measured();
    evaluate(after);
  }
  double command(size_t axis) const { return run_.number(hardware_.axes[axis].command); }
  /// Updates memories and everything between this period and the next; called after the commands are sent.
  void finish() noexcept;

  const Run<double>& run() const { return run_; }
  bool is_last() const { return run_.now().tick + hardware_.period_ticks > run_.plan().stop_tick; }
  /// Whether the plan's stop is less than this many instants ahead.
  bool ends_within(int64_t instants) const {
    return instants > (run_.plan().stop_tick - run_.now().tick) / hardware_.period_ticks;
  }
  /// The block that stopped the step, and why.
  std::string fault() const;

 private:
  struct Measured {
    double position = 0, velocity = 0;
  };
  template <class After> void evaluate(After&& after) noexcept {
    due_ = run_.due();
    run_.evaluate_watched(due_, after);
    run_.accept();
  }
  void set_between(double share) noexcept;
  void set_measured() noexcept;
  void set(size_t axis, const Measured& measured) noexcept {
    *positions_[axis] = measured.position;
    if (hardware_.axes[axis].io->velocity_channel >= 0) *velocities_[axis] = measured.velocity;
  }

  const Hardware& hardware_;
  const bool holds_;
  Run<double> run_;
  std::vector<Measured> measured_, before_;
  std::vector<double*> positions_, velocities_;
  uint64_t due_ = 0;
};

}  // namespace loopwright::hw
