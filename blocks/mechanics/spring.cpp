/// F = k (x - x₀) + F₀
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Spring {
  Real stiffness, rest_position = 0.0, preload = 0.0;
  struct In {
    Real position;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "A linear spring, such as a cable; subtract its force in the sum of forces.",
        parameter(&Spring::stiffness, "stiffness", "$force/$position", "Force per deflection").not_negative(),
        parameter(&Spring::rest_position, "rest_position", "$position", "Where it pulls neither way")
            .optional(),
        parameter(&Spring::preload, "preload", "$force", "Pull at the rest position").optional(),
        input(&In::position, "position", "$position", "Position of its moving end"),
        output(&Out::force, "force", "$force", "Pull back to the rest position: to be subtracted"));
  }
  void outputs(const In& in, Out& out) const {
    out.force = stiffness * (in.position - rest_position) + preload;
  }
};
LOOPWRIGHT_BLOCK(Spring)

}  // namespace loopwright::blocks
