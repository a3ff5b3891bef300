/// Finds the sign changes of crossing functions within a step, on the dense output of the step.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solve/ode.h"

namespace loopwright {

class StateArchive;
class Stepper;

/// Stores the last nonzero sign of every crossing, so that a value of exactly zero is neither lost nor
/// counted twice. An event is a change from one sign to the other, at the first time with the new sign.
/// Touching zero without a change of sign is no event. A crossing that has just fired is within rounding of
/// zero. If it leaves on the side opposite to its side at the restart, that is an event like any other, as
/// the decision made on that side is no longer valid.
class EventFinder {
 public:
  EventFinder(const OdeSystem& system, int samples_per_step);

  bool empty() const { return sign_.empty(); }
  std::span<const int8_t> fired() const { return fired_; }

  /// Forgets every sign, for a new solution.
  void forget();

  enum class Found : uint8_t { nothing, event, fault, non_finite };

  /// Evaluates the crossings at (t, x), after a start or restart. Returns nothing, fault or non_finite.
  Found begin(Stepper& stepper, double t, const double* x);

  /// Searches for the first event in (from, to] of the last step of the stepper; the values at `from` are
  /// known. If there is one, time() and state() are those of the right end of its bracket, which is a few
  /// rounding units of t wide, and fired() lists every crossing that changed sign in the bracket.
  Found scan(Stepper& stepper, double from, double to, const Crossing* wanted);
  double time() const { return right_.t; }
  /// How far from its zero an event at t may be reported, s: that far the times are one instant.
  static double width(double t);
  const double* state() const { return right_.x.data(); }

  /// Clears the record of fired crossings.
  void clear_fired();

  /// How often each crossing changed sign and back with only one sample in between. It may have crossed
  /// between samples as often, undetected.
  std::span<const int64_t> narrow_passages() const { return narrow_; }

  void archive(StateArchive& a);

 private:
  /// The solution and its crossing values at one time.
  struct Sample {
    double t = 0.0;
    std::vector<double> x, value;
  };

  Found look(Stepper& stepper, double t, Sample& sample);
  Found evaluate(Stepper& stepper, Sample& sample);
  bool changed(size_t crossing, const Sample& sample, const Crossing* wanted) const;
  bool any_changed(const Sample& sample, const Crossing* wanted) const;
  void pass(const Sample& sample);
  void note_returns(const Sample& sample);
  void look_beyond(Stepper& stepper, double from, double to, double departure);
  double next_sample(double from, double to, double& departure) const;
  double secant(double left_weight, double right_weight, const Crossing* wanted) const;
  Found locate(Stepper& stepper, double to, const Crossing* wanted);
  Found gather_simultaneous(Stepper& stepper, double to, const Crossing* wanted);
  void report(const Crossing* wanted);

  OdeSystem system_;
  int samples_per_step_;
  std::vector<int8_t> sign_;       ///< the last nonzero sign; 0: none yet
  std::vector<int8_t> fired_;      ///< at the last event: +1 rose, -1 fell
  std::vector<int8_t> flipped_;    ///< whether it changed its sign at the last sample
  std::vector<int64_t> narrow_;    ///< how often it changed back at the next sample
  std::vector<double> zero_band_;  ///< a crossing that has just fired counts as zero up to this size
  std::vector<int8_t> side_;       ///< its side of zero, within that band, at the restart
  bool leaving_zero_ = false;      ///< some crossing has just fired and has no sign yet
  Sample left_, right_, trial_;    ///< left_: time of the present signs
};

}  // namespace loopwright
