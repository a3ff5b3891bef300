/// y = u[index], index from 0
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Unpack {
  int index;
  struct In {
    Vector<const Real> u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("Takes one element out of a vector.",
                 parameter(&Unpack::index, "index", "", "Which element, counted from 0").not_negative(),
                 input(&In::u, "u", "$u", "Vector"), output(&Out::y, "y", "$u", "The element"));
  }
  Fault outputs(const In& in, Out& out) const {
    const bool is_inside = size_t(index) < in.u.size();
    out.y = is_inside ? in.u[size_t(index)] : Real(0.0);
    return fault_if(MaskOf<Real>(!is_inside), "the vector has no element of this index");
  }
};
LOOPWRIGHT_BLOCK(Unpack)

}  // namespace loopwright::blocks
