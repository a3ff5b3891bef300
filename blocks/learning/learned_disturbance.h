/// Shared by the blocks on learned models: the model inputs, and the behavior outside the trained velocities.
#pragma once
#include "blocks/learning/ready_model.h"

namespace loopwright::blocks {

/// - hold: the velocity is replaced by the nearest trained one;
/// - posterior: the kernel decides; it returns to the mean and to the terms that do not depend on velocity;
/// - fault: the run stops if the velocity is outside the range of rest and the trained velocities by more
///   than a twentieth of their span.
enum class Untrained { hold, posterior, fault };
constexpr auto names_of(Untrained) { return std::array<std::string_view, 3>{"hold", "posterior", "fault"}; }

/// The model's inputs for a position and velocity: x + v·lead, without the offsets of homing.
struct ModelInput {
  double homing_offset = 0, lead = 0;
  Untrained untrained = Untrained::hold;
  gp::Range trained;

  gp::Point of(double position, double velocity) const {
    const double x = position - homing_offset + velocity * lead;
    return {x, untrained == Untrained::hold ? trained.clamp(velocity) : velocity};
  }
  /// For inputs that are not finite: no prediction is possible.
  static Fault not_finite(double position, double velocity) {
    return fault_if(!(std::isfinite(position) && std::isfinite(velocity)),
                    "the position or the velocity that a learned model is evaluated at is not finite");
  }
  Fault fault(double velocity) const {
    const double low = std::min(trained.low, 0.0), high = std::max(trained.high, 0.0);
    const double margin = 0.05 * (high - low);
    return fault_if(untrained == Untrained::fault && !(velocity >= low - margin && velocity <= high + margin),
                    "the velocity lies outside of those the model was trained on");
  }
};

}  // namespace loopwright::blocks
