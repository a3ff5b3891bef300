/// y = ln u, log₂ u or log₁₀ u
#include "engine/block.h"
#include "models/real/double_functions.h"
#include "models/real/each_lane.h"

namespace loopwright::blocks {

enum class LogarithmBase { e, two, ten };
constexpr auto names_of(LogarithmBase) { return std::array<std::string_view, 3>{"e", "2", "10"}; }

template <class Real> struct Logarithm {
  LogarithmBase base = LogarithmBase::e;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("The logarithm of a signal.",
                 parameter(&Logarithm::base, "base", "", "Its base; e: the natural logarithm").optional(),
                 input(&In::u, "u", "", "Signal above 0"), output(&Out::y, "y", "", "Its logarithm"));
  }
  Fault outputs(const In& in, Out& out) const {
    out.y = base == LogarithmBase::e     ? natural_logarithm(in.u)
            : base == LogarithmBase::two ? each_lane(&binary_logarithm, in.u)
                                         : each_lane(&decimal_logarithm, in.u);
    return fault_if(!(in.u > 0.0), "the logarithm of a number that is not above 0");
  }
};
LOOPWRIGHT_BLOCK(Logarithm)

}  // namespace loopwright::blocks
