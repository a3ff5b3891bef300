/// y = (element₁, element₂, …)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Pack {
  struct In {
    Many<Real> elements;
  };
  struct Out {
    Vector<Real> y;
  };
  static constexpr auto describe() {
    return block("Strings signals together to one vector; vectors among them are taken element by element.",
                 input(&In::elements, "elements", "$y", "Signals of one unit").joins(),
                 output(&Out::y, "y", "$y", "The vector").length(&In::elements));
  }
  void outputs(const In& in, Out& out) const {
    for (int i = 0; i < in.elements.size(); ++i) out.y[size_t(i)] = in.elements[i];
  }
};
LOOPWRIGHT_BLOCK(Pack)

}  // namespace loopwright::blocks
