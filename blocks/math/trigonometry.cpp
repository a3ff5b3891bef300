/// y = sin u, cos u, tan u, asin u, acos u, atan u, sinh u, cosh u or tanh u
///
/// Angles are in rad, on either side. asin and acos of a number beyond ±1 stop the run. The angle of a point
/// is Atan2. A source is Sine.
#include "blocks/math/sides.h"
#include "models/real/double_functions.h"
#include "models/real/each_lane.h"

namespace loopwright::blocks {

enum class AngleFunction { sin, cos, tan, asin, acos, atan, sinh, cosh, tanh };
constexpr auto names_of(AngleFunction) {
  return std::array<std::string_view, 9>{"sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"};
}

template <class Real> struct Trigonometry {
  AngleFunction function;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Crossings {
    Real pole;
  };
  static constexpr auto describe() {
    return block("A trigonometric or hyperbolic function.",
                 parameter(&Trigonometry::function, "function", "", "Which function"),
                 input(&In::u, "u", "$u", "Angle in rad, or a number without unit for an inverse function"),
                 output(&Out::y, "y", "$y", "The function of it"), crossing(&Crossings::pole, "pole"));
  }
  std::vector<UnitClaim> unit_claims() const {
    const bool takes_angle =
        function == AngleFunction::sin || function == AngleFunction::cos || function == AngleFunction::tan;
    const bool gives_angle =
        function == AngleFunction::asin || function == AngleFunction::acos || function == AngleFunction::atan;
    const Unit rad = parse_unit("rad").value();
    return {{"$u", takes_angle ? rad : Unit{}, "function"}, {"$y", gives_angle ? rad : Unit{}, "function"}};
  }
  Fault outputs(const In& in, Out& out) const {
    out.y = value(in.u);
    return fault_if(!is_finite(out.y), "the function has no finite value there");
  }
  bool may_cross() const { return function == AngleFunction::tan; }
  void crossings(const In& in, Crossings& value) const { value.pole = above_zero(cosine(in.u)); }

 private:
  Real value(const Real& u) const {
    switch (function) {
      case AngleFunction::sin:
        return sine(u);
      case AngleFunction::cos:
        return cosine(u);
      case AngleFunction::tan:
        return each_lane(&tangent, u);
      case AngleFunction::asin:
        return each_lane(&arc_sine, u);
      case AngleFunction::acos:
        return each_lane(&arc_cosine, u);
      case AngleFunction::atan:
        return arc_tangent(u);
      case AngleFunction::sinh:
        return each_lane(&hyperbolic_sine, u);
      case AngleFunction::cosh:
        return each_lane(&hyperbolic_cosine, u);
      case AngleFunction::tanh:
        return hyperbolic_tangent(u);
    }
    return u;
  }
};
LOOPWRIGHT_BLOCK(Trigonometry)

}  // namespace loopwright::blocks
