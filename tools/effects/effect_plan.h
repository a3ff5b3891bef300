/// An effect's blocks compiled for a machine and a record.
#pragma once
#include <memory>
#include "engine/plan/plan.h"
#include "tools/effects/effect_values.h"

namespace loopwright {

/// An effect compiled for a machine and a record; shared by runs and threads.
struct EffectPlan {
  /// A number of a block that depends on the effect's parameters.
  struct Binding {
    std::string path;  ///< in the plan, "effect.friction.level"
    Value value;       ///< as written: "=level"
  };
  Effect effect;
  RecordSizes sizes;
  std::vector<std::string> fitted;  ///< the parameters that `EffectRun::set` sets, in their order
  std::vector<Binding> bindings;
  Plan plan;
  Number output = 0;           ///< output of the effect, at an instant
  std::vector<Number> slopes;  ///< those that its blocks state, to be added to the observed slope of `output`
  Number integral = -1;        ///< the same, integrated; -1: it has no states or rates of its own
  bool acts_on_sensor = false;
  bool flies = false;     ///< has states of its own, and contact that closes and opens
  bool remembers = true;  ///< otherwise a sample depends only on itself, not even on time
  /// Remembers nothing but accepted memory, of numbers: see SegmentRun.
  bool remembers_way = false;
  /// Linear in one held signal and in samples of it that it remembers: see HeldEffect.
  bool is_held = false;
  /// Has states, which and whose force are linear in the signals and in themselves, and nothing else that
  /// remembers: see EffectRun.
  bool is_linear = false;
  bool is_switched = false;  ///< linear in the same way as long as nothing is decided: see switched_effect.h
  /// Of a switched effect: the same with shorter steps, for the few samples in which something is decided;
  /// and of that the same again, for the steps in which it is.
  std::shared_ptr<const EffectPlan> finer;
  /// Of a switched effect that allows it: the same with one step a sample, to rank a grid of shapes by. It
  /// counts as an effect like any other, so that many sets run in lanes.
  std::shared_ptr<const EffectPlan> coarser;
};

/// Fitted parameters by which the kind of an effect is tried: linear ones at their typical values, the others
/// at these values of their ranges.
std::vector<double> tried_values(const EffectPlan& plan, double FitRange::*at);

/// Null after a problem: blocks that do not exist, units incompatible with the machine's.
std::shared_ptr<const EffectPlan> compile_effect(const Effect& effect, const MachineUnits& units,
                                                 const RecordSizes& sizes, Problems& problems);

}  // namespace loopwright
