/// y = (u[indices[0]], u[indices[1]], …), indices from 0
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Selector {
  std::vector<int> indices;
  struct In {
    Vector<const Real> u;
  };
  struct Out {
    Vector<Real> y;
  };
  static constexpr auto describe() {
    return block(
        "Takes elements out of a vector, in any order.",
        parameter(&Selector::indices, "indices", "", "Which elements, counted from 0").not_negative(),
        input(&In::u, "u", "$u", "Vector"),
        output(&Out::y, "y", "$u", "The elements").length(&Selector::elements));
  }
  int elements() const { return int(indices.size()); }
  void check(const Checker& checker) const {
    if (indices.empty())
      checker.error("indices", "no element is selected").expected = "the numbers of elements, as in [2, 0]";
  }
  Fault outputs(const In& in, Out& out) const {
    bool all_exist = true;
    for (size_t i = 0; i < indices.size(); ++i) {
      const bool exists = size_t(indices[i]) < in.u.size();
      out.y[i] = exists ? in.u[size_t(indices[i])] : Real(0.0);
      all_exist &= exists;
    }
    return fault_if(MaskOf<Real>(!all_exist), "the vector has no element of this index");
  }
};
LOOPWRIGHT_BLOCK(Selector)

}  // namespace loopwright::blocks
