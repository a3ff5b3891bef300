/// Effects with states of their own that are linear as long as nothing is decided anew: a load that is driven
/// through a gap flies free or touches a flank, and each is linear.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "tools/effects/linear_effect.h"
#include "tools/effects/step_maps.h"

namespace loopwright {

/// Such an effect, one sample at a time from any states, with derivatives.
class SwitchedSample {
 public:
  /// `fitted`: all its parameters in SI.
  SwitchedSample(std::shared_ptr<const EffectPlan> plan, const std::vector<double>& fitted);
  SwitchedSample(const SwitchedSample&) = delete;  // its steps refer to its blocks
  SwitchedSample& operator=(const SwitchedSample&) = delete;

  /// Its states at the start of a motion.
  std::vector<double> start(double position, double velocity);
  /// How these follow the position and the velocity with which the motion starts.
  struct Follows {
    double position = 0, velocity = 0;
  };
  const std::vector<Follows>& follows() const { return follows_; }
  /// The body against which it acts; its added inertia is that of the effect. Without one it is moved as the
  /// given signals say.
  void set_body(const EffectSample::Body& body);
  /// The states after a sample, then mean and slope of the force: see EffectSample::from() and against().
  const std::vector<double>& from(const std::vector<double>& states, const GivenSignals& given);
  /// Index in maps() of the derivatives of the sample that was asked for last. Samples in which nothing is
  /// decided anew share the map of their mode.
  uint32_t map_of(const std::vector<double>& states, const GivenSignals& given);
  const std::vector<SampleMap>& maps() const { return maps_; }

 private:
  friend bool is_switched(const std::shared_ptr<const EffectPlan>& plan);
  friend bool resolves(const std::shared_ptr<const EffectPlan>& steps,
                       const std::shared_ptr<const EffectPlan>& plan);
  /// Maps of samples that decide alike, at the first values of the parameters.
  struct Modes {
    size_t states;
    std::vector<double> differences;  ///< of states and signals
    std::map<std::string, std::vector<SampleMap>> maps;
    /// By how much the states and the mean force differ from the first of the other's maps of the same mode,
    /// as a share of what the differences change most.
    double apart(const Modes& other) const;
  };
  static Modes modes_of(const std::shared_ptr<const EffectPlan>& plan);
  /// A sample in which nothing is decided anew: the map about one of them.
  struct Mode {
    std::vector<double> states;
    GivenSignals given;
    std::vector<double> result;
    uint32_t map;
  };
  std::vector<double> integrated(const std::vector<double>& states, const GivenSignals& given);
  GivenSignals at_end(const GivenSignals& given, double mean_force) const;
  /// Of each state and signal, for a change of the velocity of this size; zero: the sample does not depend on
  /// it.
  std::vector<double> differences(double size) const;
  /// Derivatives of the last integrated sample, with this result; whether all differences decided as it did.
  bool differ(const std::vector<double>& states, const GivenSignals& given, const std::vector<double>& result,
              double size, SampleMap& map);
  /// Sets the result by the map of a mode; whether the blocks still decide so at the end of the sample.
  bool follow(const Mode& mode, const std::vector<double>& states, const GivenSignals& given);

  std::shared_ptr<const EffectPlan> plan_;
  std::vector<double> fitted_;
  EffectSample sample_;
  std::unique_ptr<EffectSample> finer_;  // for steps in which something is decided; null: there is none
  std::optional<EffectSample::Body> body_;
  std::optional<StepMaps> steps_;  // against the body
  std::vector<Follows> follows_;
  std::vector<SampleMap> maps_;
  std::map<std::string, Mode> modes_;
  const Mode* followed_ = nullptr;  // that of the last sample; null: something was decided anew
  bool in_steps_ = false;           // by whose maps the last sample went
  std::vector<double> result_, ends_;
};

/// Whether the blocks of an effect remember nothing but states, decide something, and are linear in between.
bool is_switched(const std::shared_ptr<const EffectPlan>& plan);
/// Whether these steps, longer than those of the plan, are short enough to compare shapes by.
bool resolves(const std::shared_ptr<const EffectPlan>& steps, const std::shared_ptr<const EffectPlan>& plan);

}  // namespace loopwright
