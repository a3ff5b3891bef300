/// deviation = √var[d(x + v·lead, v)], the standard deviation of a Gaussian process prediction
///
/// It is the deviation of the disturbance itself, without the observation noise. It is large where there were
/// no samples. It does not detect a wrong phase, payload or homing.
#include <cmath>
#include "blocks/learning/learned_disturbance.h"

namespace loopwright::blocks {

struct GprDeviation {
  std::string model;
  double lead = 0, homing_shift = 0;
  Untrained untrained = Untrained::posterior;
  std::shared_ptr<const ReadyModel> ready;
  double homing_offset = 0;
  gp::Range trained;
  struct In {
    double position, velocity;
  };
  struct Out {
    double deviation;
  };
  static constexpr auto describe() {
    using B = GprDeviation;
    return block(
        "Says how unsure a learned model is of its prediction.",
        parameter(&B::model, "model", "", "Model file, relative to the diagram").file(),
        parameter(&B::lead, "lead", "s", "Predicts for where the part will be after this time").optional(),
        parameter(&B::homing_shift, "homing_shift", "$position",
                  "How much more the position reads now than it did at training")
            .optional(),
        parameter(
            &B::untrained, "untrained", "",
            "Beyond the trained velocities: the nearest one, what the kernel says, or a stop of the run")
            .optional(),
        input(&In::position, "position", "$position", "Position of the moving part"),
        input(&In::velocity, "velocity", "$position/s", "Its velocity"),
        output(&Out::deviation, "deviation", "$command", "Standard deviation of the predicted disturbance"));
  }
  std::vector<UnitClaim> unit_claims() const {
    return ready ? ready->unit_claims() : std::vector<UnitClaim>();
  }
  void check(const Checker& checker) {
    ready = ready_model(checker, "model", model);
    if (!ready) return;
    homing_offset = ready->learned.model.homing_offset;
    trained = ready->learned.model.trained[1];
  }
  /// The first evaluation on a thread allocates its buffers, so that steps allocate nothing.
  void prepare(double) { ready->posterior.variance({}); }
  Fault outputs(const In& in, Out& out) const {
    out.deviation = 0;
    if (const Fault fault = ModelInput::not_finite(in.position, in.velocity); fault.lanes) return fault;
    const ModelInput input{homing_offset + homing_shift, lead, untrained, trained};
    out.deviation = std::sqrt(ready->posterior.variance(input.of(in.position, in.velocity)));
    return input.fault(in.velocity);
  }
};
LOOPWRIGHT_BLOCK(GprDeviation)

}  // namespace loopwright::blocks
