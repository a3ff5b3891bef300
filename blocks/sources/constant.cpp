/// y = value
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Constant {
  Real value;
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("A number that does not change.", parameter(&Constant::value, "value", "$y", "The number"),
                 output(&Out::y, "y", "$y", "The number"));
  }
  void outputs(Out& out) const { out.y = value; }
};
LOOPWRIGHT_BLOCK(Constant)

}  // namespace loopwright::blocks
