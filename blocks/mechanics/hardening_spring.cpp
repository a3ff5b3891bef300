/// F = k d + k₃ d³ + F₀,  d = x - x₀   (Duffing 1918)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct HardeningSpring {
  Real stiffness = 0.0, cubic_stiffness, rest_position = 0.0, preload = 0.0;
  struct In {
    Real position;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "A spring that stiffens (or softens) with deflection; subtract its force in the sum of forces.",
        parameter(&HardeningSpring::stiffness, "stiffness", "$force/$position",
                  "Force per deflection at rest")
            .optional(),
        parameter(&HardeningSpring::cubic_stiffness, "cubic_stiffness", "$force/$position^3",
                  "Force per cube of deflection; negative softens"),
        parameter(&HardeningSpring::rest_position, "rest_position", "$position", "Where it pulls neither way")
            .optional(),
        parameter(&HardeningSpring::preload, "preload", "$force", "Pull at the rest position").optional(),
        input(&In::position, "position", "$position", "Position of its moving end"),
        output(&Out::force, "force", "$force", "Pull back to the rest position: to be subtracted"));
  }
  void outputs(const In& in, Out& out) const {
    const Real d = in.position - rest_position;
    out.force = (stiffness + cubic_stiffness * d * d) * d + preload;
  }
};
LOOPWRIGHT_BLOCK(HardeningSpring)

}  // namespace loopwright::blocks
