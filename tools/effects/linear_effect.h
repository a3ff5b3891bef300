/// Effects that are linear in their states and in the signals that they are given, as a load on a spring or a
/// lag is: a sample of theirs is a product with a matrix, which costs a small part of integrating it.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "engine/run/run.h"
#include "tools/effects/effect_plan.h"
#include "tools/effects/role_signals.h"

namespace loopwright {

/// One sample of a linear effect: the states after it, and the mean and the slope of its force (see
/// EffectRun), from the states before it and the given signals.
struct SampleMap {
  size_t states = 0;
  /// One for each state, then for each given signal: its effect on the states, the mean and the slope.
  std::vector<std::vector<double>> columns;

  /// `result` is states, mean and slope.
  void apply(const std::vector<double>& before, const GivenSignals& given, std::vector<double>& result) const;
};

/// The same maps of several sets of parameters side by side, each with its own states.
class SampleMaps {
 public:
  /// `states`: of each map, before the first sample.
  SampleMaps(std::span<const SampleMap> maps, std::span<const std::vector<double>> states);
  /// The next sample, with the same numbers as SampleMap::apply.
  void step(const GivenSignals& given);
  /// Of each set.
  const double* means() const { return &result_[states_ * sets_]; }
  const double* slopes() const { return &result_[(states_ + 1) * sets_]; }

 private:
  size_t states_, sets_;
  std::vector<double> matrix_;           ///< columns, in each the rows, in each the sets
  std::vector<double> before_, result_;  ///< rows, in each the sets
};

/// The blocks of an effect with states of its own, one sample at a time.
class EffectSample {
 public:
  explicit EffectSample(std::shared_ptr<const EffectPlan> plan);

  /// Back to the start, with these fitted parameters and the first position and velocity of a record.
  void start(const std::vector<double>& fitted, double position, double velocity);
  std::vector<double> states();
  /// The states after a sample from given states, then mean and slope of the force.
  std::vector<double> from(const std::vector<double>& states, const GivenSignals& given);
  /// What it pushes against, if it is not moved as the given signals say: they are those of the motion
  /// without the effect, and its force, consumed, gives this body an acceleration within the sample.
  struct Body {
    double inertia;        ///< force per acceleration
    double added_inertia;  ///< what the effect consumes of it per acceleration is part of the body already
  };
  /// The states after a sample, then mean and slope of the force on the body.
  std::vector<double> against(const Body& body, const std::vector<double>& states, const GivenSignals& given);
  /// Both between two steps of a sample.
  struct Instant {
    std::vector<double> states;
    double position = 0, velocity = 0;
    double push = 0;  ///< mean force on the body over the step before, by which the next one begins
  };
  /// One step of against(); decided() is what the blocks decide at its start.
  void step_against(const Body& body, double free_acceleration, Instant& instant);
  /// Equal steps in a sample; 0 if the last one is shorter.
  int steps() const;
  /// By superposition; valid for linear effects.
  SampleMap map();
  /// What the blocks decide at an instant: the bytes of their modes.
  const std::string& decide(const std::vector<double>& states, const GivenSignals& given);
  /// What they had decided at the start of the last sample.
  const std::string& decided() const { return decided_; }
  /// Whether they decided otherwise within it or at its end.
  bool decided_anew() const { return decided_anew_; }

 private:
  struct Wire {  // a parameter of an ExternalSignal
    double* number;
    GivenSignals::Index signal;
    double factor;
  };
  struct Mode {
    const char* bytes;
    size_t size;
  };
  void note_decisions(bool is_start);
  /// A step from the present states, the first of a sample if `is_start`. `now`: at its start, then at its
  /// end. Returns the mean force on the body over it, from that over the step before.
  double push_body(const Body& body, double free_acceleration, int64_t ticks, bool is_start,
                   GivenSignals& now, double push);
  void evaluate();
  void set_states(const std::vector<double>& states);
  void give(const GivenSignals& given);
  void wire(const char* role, GivenSignals::Index value, GivenSignals::Index slope, bool is_line,
            double bend_factor);

  std::shared_ptr<const EffectPlan> plan_;
  Run<double> run_;
  std::vector<double*> bound_, since_;
  std::vector<double> before_;  // states at the start of a step
  std::vector<Wire> wires_;
  std::vector<size_t> states_;  // without the integral
  std::vector<Mode> modes_;
  std::string decided_;
  bool decided_anew_ = false;
  int64_t sample_ticks_ = 1;
};

/// Whether the blocks of an effect remember nothing but states, and superposition holds over all magnitudes
/// of states and signals, at typical values and at both ends of the ranges of the parameters.
bool is_linear(const std::shared_ptr<const EffectPlan>& plan);

}  // namespace loopwright
