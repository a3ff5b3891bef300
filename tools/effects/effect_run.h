/// Runs an effect's blocks on given signals: fast, with parameters that change without recompiling.
#pragma once
#include <memory>
#include <span>
#include "tools/effects/effect_lanes.h"
#include "tools/effects/effect_plan.h"
#include "tools/effects/held_effect.h"
#include "tools/effects/linear_effect.h"
#include "tools/effects/role_signals.h"
#include "tools/effects/segment_run.h"

namespace loopwright {

/// Runs an effect on SIMD lanes: several sets of parameters in parallel if requested, and, if the effect has
/// no memory, many samples of one set. Its result for each sample is
///   acting on force or parameters: the force that it consumes [force], mean over the sample
///   acting on the input:           the change of the input [input], mean over the sample
///   acting on the sensor:          the change of the measured position [position], at the sample
/// Within a sample the position is a parabola and the velocity a straight line, or with a bow a cubic and a
/// parabola; of an effect with memory the bow is left out. Input and force are held. The mean
/// is computed by two-point Gauss quadrature if the effect has no states, else by an additional
/// integrator. In addition to the mean there is a slope: the change over the sample of the straight line with
/// the same first moment. A rapidly oscillating force moves the axis by its slope as well as by its mean.
/// What acts on the sensor is read at an instant, and has none. Of a linear effect with states only one
/// sample is integrated for each state and signal; the others follow by superposition. Of a switched one (see
/// switched_effect.h) only those are integrated in which something is decided, of one set after the other.
class EffectRun {
 public:
  /// `lanes`: requested number of sets; see lanes().
  explicit EffectRun(std::shared_ptr<const EffectPlan> plan, int lanes = 1);

  /// Number of sets of parameters run in parallel: one, or the number of lanes of this machine.
  int lanes() const { return int(fitted_.size()); }
  /// Sets a fitted parameter in SI, by its index in EffectPlan::fitted; takes effect at the next start.
  void set(size_t parameter, double value, int lane = 0) { fitted_[size_t(lane)].at(parameter) = value; }
  double get(size_t parameter, int lane = 0) const { return fitted_[size_t(lane)].at(parameter); }
  /// Keeps only this linear parameter, at its typical magnitude, which is returned: some effects are linear
  /// only up to a limit.
  double isolate(size_t parameter, int lane = 0);
  /// Starts, and writes one value per row, the rows of lane 0, then those of lane 1, …: values.size() is a
  /// multiple of the rows; lanes beyond it are left out. Throws std::invalid_argument if a role that is read
  /// is missing.
  void run(const RoleSignals& signals, size_t rows, std::span<double> values);
  void run(const RoleSignals& signals, std::span<double> values) { run(signals, values.size(), values); }
  /// The same with the slopes, times a factor, as one column per lane; lanes beyond the list are left out.
  struct Output {
    double factor = 1;
    std::vector<float> mean, slope;
  };
  void run(const RoleSignals& signals, size_t rows, std::span<Output> outputs);
  /// The same with one fitted parameter at 1 and all other linear ones at 0: the column of a linear
  /// parameter.
  void column(const RoleSignals& signals, size_t parameter, std::span<double> values);

 private:
  /// Sets value and slope of the lanes to those of the next sample.
  void step(const RoleSample& sample);
  /// The same of the first `rows` of `samples_` for an effect without memory, one per lane.
  void mean_of(size_t rows, double now);
  void give_at(double fraction, size_t rows);
  void integrate_sample();
  void refuse_faults(const RoleSignals& signals, size_t rows) const;
  /// Passes each value and slope to take(lane, row, value, slope).
  template <class Take> void run_lanes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void run_in_turn(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take>
  bool run_in_segments(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void run_side_by_side(const RoleSignals& signals, size_t rows, Take&& take);
  template <class Take> void superpose(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void answer(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void follow_modes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);

  std::shared_ptr<const EffectPlan> plan_;
  bool reads_held_signals_;                  // and nothing else
  std::vector<double> starts_;               // of each fitted parameter
  std::vector<std::vector<double>> fitted_;  // of each set
  std::unique_ptr<EffectSample> linear_;     // of a linear effect
  std::unique_ptr<HeldEffect> held_;         // of an effect that remembers samples of one held signal
  std::unique_ptr<SegmentRun> segments_;     // of a few sets of what remembers only accepted memory
  std::unique_ptr<EffectLanes> lanes_;       // empty, as all that follows, where samples have maps
  std::vector<RoleSample> samples_;          // one per lane
  std::vector<double> slope_, integral_, before_, area_;  // one per lane
};

}  // namespace loopwright
