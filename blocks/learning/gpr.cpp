/// prediction = mean + E[d(x + v·lead, v)], the posterior mean of a Gaussian process
///
/// The model comes from `loopwright gp train` and is read once, when the diagram is compiled. Bring the
/// prediction into a loop through a CompensationFilter, which also has the weight and its ramp. A prediction
/// takes a few table look-ups; its error is less than a millionth of the prior deviation (see
/// models/gp/table.h). "exact" evaluates the kernel instead.
#include "blocks/learning/learned_disturbance.h"

namespace loopwright::blocks {

enum class Prediction { table, exact };
constexpr auto names_of(Prediction) { return std::array<std::string_view, 2>{"table", "exact"}; }

struct Gpr {
  std::string model;
  double lead = 0, homing_shift = 0;
  Untrained untrained = Untrained::hold;
  Prediction prediction = Prediction::table;
  std::shared_ptr<const ReadyModel> ready;
  const gp::MeanTable* table = nullptr;  // table of `ready`
  double homing_offset = 0;
  gp::Range trained;
  struct In {
    double position, velocity;
  };
  struct Out {
    double prediction;
  };
  static constexpr auto describe() {
    return block(
        "Predicts a disturbance from position and velocity with a learned model.",
        parameter(&Gpr::model, "model", "", "Model file, relative to the diagram").file(),
        parameter(&Gpr::lead, "lead", "s", "Predicts for where the part will be after this time").optional(),
        parameter(&Gpr::homing_shift, "homing_shift", "$position",
                  "How much more the position reads now than it did at training")
            .optional(),
        parameter(
            &Gpr::untrained, "untrained", "",
            "Beyond the trained velocities: the nearest one, what the kernel says, or a stop of the run")
            .optional(),
        parameter(&Gpr::prediction, "prediction", "", "By tables with an error bound, or exactly").optional(),
        input(&In::position, "position", "$position", "Position of the moving part"),
        input(&In::velocity, "velocity", "$position/s", "Its velocity"),
        output(&Out::prediction, "prediction", "$command", "Predicted disturbance"));
  }
  std::vector<UnitClaim> unit_claims() const {
    return ready ? ready->unit_claims() : std::vector<UnitClaim>();
  }
  void check(const Checker& checker) {
    ready = ready_model(checker, "model", model);
    if (!ready) return;
    table = &ready->table();
    homing_offset = ready->learned.model.homing_offset;
    trained = ready->learned.model.trained[1];
  }
  /// The first evaluation on a thread allocates its buffers, so that steps allocate nothing.
  void prepare(double) {
    if (prediction == Prediction::exact) ready->posterior.mean({});
  }
  Fault outputs(const In& in, Out& out) const {
    out.prediction = 0;
    if (const Fault fault = ModelInput::not_finite(in.position, in.velocity); fault.lanes) return fault;
    const ModelInput input{homing_offset + homing_shift, lead, untrained, trained};
    const gp::Point at = input.of(in.position, in.velocity);
    out.prediction = prediction == Prediction::table ? (*table)(at) : ready->posterior.mean(at);
    return input.fault(in.velocity);
  }
};
LOOPWRIGHT_BLOCK(Gpr)

}  // namespace loopwright::blocks
