/// An effect's blocks, run on given signals: fast, with parameters that change without compiling anew.
#pragma once
#include <memory>
#include <span>
#include "engine/lanes/lane_run.h"
#include "tools/effects/effect_plan.h"

namespace loopwright {

/// What the effect may read at one sample; roles that it does not read are of no matter.
struct RoleSample {
  double position = 0, velocity = 0, acceleration = 0, input = 0, force = 0;
  /// At the next sample; NaN: the velocity goes on by the acceleration, which stays. Leave it so where the
  /// value must not depend on later measurements.
  double next_velocity = std::numeric_limits<double>::quiet_NaN();
  double next_acceleration = std::numeric_limits<double>::quiet_NaN();
};

/// Columns of a record, or of a predictor; empty where the effect does not read them.
struct RoleSignals {
  std::span<const double> position, velocity, acceleration, input, force;
  /// True: within a sample velocity and acceleration go to those of the next, as is best for a look at the
  /// whole record.
  /// False: it goes on by velocity and acceleration, so that row k depends on rows up to k alone.
  bool looks_ahead = false;

  size_t rows() const;
  RoleSample at(size_t row) const;
};

/// Runs an effect on SIMD lanes: several sets of parameters side by side if so wished, and, where the effect
/// remembers nothing, many samples of one set. What it gives for each sample is
///   acting on force or parameters: the force that it consumes [force], mean over the sample
///   acting on the input:           what it adds to the input [input], mean over the sample
///   acting on the sensor:          what it adds to the measured position [position], at the sample
/// Within a sample the position is a parabola and velocity a straight line; input and force are held. The
/// mean is by Gauss's two points where the effect has no states, else by an integrator beside them. Beside
/// the mean there is a slope: the change over the sample of the straight line with the same first moment. A
/// force that swings fast moves the axis by its slope as well as by its mean.
class EffectRun {
 public:
  /// `lanes`: how many sets are wanted; see lanes().
  explicit EffectRun(std::shared_ptr<const EffectPlan> plan, int lanes = 1);

  /// Sets of parameters that run side by side: one, or as many as this machine has lanes for.
  int lanes() const { return int(fitted_.size()); }
  /// A fitted parameter in SI, by its place in EffectPlan::fitted; counts from the next start.
  void set(size_t parameter, double value, int lane = 0) { fitted_[size_t(lane)].at(parameter) = value; }
  double get(size_t parameter, int lane = 0) const { return fitted_[size_t(lane)].at(parameter); }
  /// Leaves of all linear parameters this one, at its usual magnitude, which is returned: some effects are
  /// straight only up to a limit.
  double isolate(size_t parameter, int lane = 0);
  /// Starts, and fills one value a row, the rows of lane 0, then those of lane 1, …: values.size() is a
  /// multiple of the rows, lanes beyond it are left out. Throws std::invalid_argument when a role that is
  /// read is missing.
  void run(const RoleSignals& signals, size_t rows, std::span<double> values);
  void run(const RoleSignals& signals, std::span<double> values) { run(signals, values.size(), values); }
  /// The same with the slopes, times a factor, as a column a lane; lanes beyond the list are left out.
  struct Output {
    double factor = 1;
    std::vector<float> mean, slope;
  };
  void run(const RoleSignals& signals, size_t rows, std::span<Output> outputs);
  /// The same with one fitted parameter at 1 and all other linear ones at 0: the column of a linear
  /// parameter.
  void column(const RoleSignals& signals, size_t parameter, std::span<double> values);

 private:
  struct Setting {  // a parameter of an ExternalSignal, in every lane
    std::vector<double*> lanes;
    bool is_row = false;  // one lane lies beside the other
    void set(double to, size_t from, size_t end) const;
  };
  struct Wire {
    Setting value, slope, bend, since;
  };
  Wire wire(const char* role);
  /// Back to rest at the first sample.
  void start(const RoleSample& first);
  /// Fills `value_` and `slope_` with those of the next sample, one a lane.
  void step(const RoleSample& sample);
  /// The same over samples that were given, at the two points of Gauss from `now` on.
  void mean_from(double now);
  void integrate_sample();
  /// Of what its blocks give now: the value, and the slope that they state.
  void read_held();
  /// Each value and slope goes to take(lane, row, value, slope).
  template <class Take> void run_lanes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void run_in_turn(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take);
  template <class Take> void run_side_by_side(const RoleSignals& signals, size_t rows, Take&& take);
  /// To the lanes from `from` up to `to`.
  void give(const RoleSample& sample, double now, size_t from, size_t to);
  void read(Number number, std::vector<double>& to) const { run_->read({&number, 1}, to.data()); }

  std::shared_ptr<const EffectPlan> plan_;
  std::unique_ptr<LaneRun> run_;
  std::vector<std::vector<double>> fitted_;  // of each lane
  std::vector<std::vector<double*>> bound_;
  Wire position_, velocity_, acceleration_, input_, force_;
  int64_t sample_ticks_ = 1;
  std::vector<double> value_, slope_, stated_slope_, integral_, second_, area_;  // a lane each
};

}  // namespace loopwright
