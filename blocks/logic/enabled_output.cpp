/// y = u while on is true, else 0
///
/// The output of a subdiagram with "while_disabled": {"outputs": "reset"} is made of one. While it is off, u
/// may be anything, also infinite or NaN.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct EnabledOutput {
  struct In {
    Real u, on;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("Passes a signal while a subdiagram runs.",
                 input(&In::u, "u", "$y", "Signal of the subdiagram"),
                 input(&In::on, "on", "", "Whether the subdiagram runs"),
                 output(&Out::y, "y", "$y", "The signal, or 0"));
  }
  void outputs(const In& in, Out& out) const { out.y = select(is_true(in.on), in.u, Real(0.0)); }
};
LOOPWRIGHT_BLOCK(EnabledOutput)

}  // namespace loopwright::blocks
