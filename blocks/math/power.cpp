/// y = u to the power `exponent`
///
/// A negative u has whole powers only; 0 has none below 0. The unit of y is that of u to the same power.
#include "engine/block.h"
#include "models/real/double_functions.h"
#include "models/real/each_lane.h"

namespace loopwright::blocks {

template <class Real> struct Power {
  Real exponent;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("A signal to a fixed power.", parameter(&Power::exponent, "exponent", "", "The power"),
                 input(&In::u, "u", "?", "Signal"), output(&Out::y, "y", "$y", "Its power"));
  }
  double unit_power(int) const { return lane(exponent, 0); }
  Fault outputs(const In& in, Out& out) const {
    out.y = each_lane(&any_power, in.u, exponent);
    return fault_if(!is_finite(out.y), "the power is not a finite number");
  }
};
LOOPWRIGHT_BLOCK(Power)

}  // namespace loopwright::blocks
