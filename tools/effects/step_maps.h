/// A sample of an effect and the body that it pushes, as the product of its steps: within a step what the
/// blocks decide is held, and each is linear.
#pragma once
#include <Eigen/Dense>
#include <map>
#include <memory>
#include <string>
#include <vector>
#include "tools/effects/linear_effect.h"

namespace loopwright {

/// The steps of EffectSample::against(), each by the map of what is decided at its start. A map is learned
/// once, by differences of one step; after that a sample in which something is decided anew, and its
/// derivative, need no integration. A step within which something is decided is taken again in steps of the
/// finer maps: a contact that begins late is too weak.
class StepMaps {
 public:
  /// `differences`: of the states and given signals, zero if the effect does not depend on one. `finer`: of
  /// the same effect in shorter steps, of which some make one of these; null: there are none.
  StepMaps(EffectSample& sample, const EffectSample::Body& body, const std::vector<double>& differences,
           std::unique_ptr<StepMaps> finer);

  /// The states after a sample, then mean and slope of the force on the body. False if a decision of a step
  /// that is not known yet hangs on the differences.
  bool follow(const std::vector<double>& states, const GivenSignals& given, std::vector<double>& result);
  /// The derivative of the sample that was followed last.
  void differentiate(SampleMap& map);

 private:
  /// Of a step: z' = to + slopes (z - from), with z the states, position, velocity, mean force over the step
  /// before, and free acceleration, of which the last does not change.
  struct StepMap {
    Eigen::VectorXd from, to;
    Eigen::MatrixXd slopes;
  };
  /// A step that was taken: when, as a part of the sample, and the force on the body over it.
  struct Taken {
    const StepMap* map;
    double begin, length, push;
  };
  /// Takes steps from z on; false, and z is spoilt, if one of them is not known.
  bool take(size_t steps, double begin, const GivenSignals& given, Eigen::VectorXd& z,
            std::vector<Taken>& taken);
  /// The same from before a step that ends at z, in finer steps. They replace the last one that was taken.
  bool take_again(const Eigen::VectorXd& before, const GivenSignals& given, Eigen::VectorXd& z,
                  std::vector<Taken>& taken);
  /// Null if a decision hangs on the differences.
  const StepMap* map_at(const Eigen::VectorXd& z, const GivenSignals& given);
  /// z after a step that is integrated, and whether the blocks decide so at its start.
  bool integrate(const Eigen::VectorXd& z, const std::string& decided, Eigen::VectorXd& next);

  EffectSample& sample_;
  EffectSample::Body body_;
  Eigen::Index states_;
  std::unique_ptr<StepMaps> finer_;
  Eigen::VectorXd differences_, z_, next_, before_;
  EffectSample::Instant instant_;
  std::map<std::string, StepMap> maps_;
  std::vector<Taken> taken_;  // by the sample that was followed last
  Eigen::MatrixXd slopes_, next_slopes_;
};

}  // namespace loopwright
