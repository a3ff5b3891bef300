/// What a formula can call: one list, for the parser that computes and for the one that notes what is
/// computed.
#pragma once
#include <muParser.h>
#include <algorithm>
#include <cmath>
#include "models/real/double_functions.h"

namespace loopwright {

/// muParser does not allow its ^ to be replaced. Formulas are therefore passed to it with an operator that it
/// does not define.
inline constexpr char written_power = '^', parsed_power = '~';

namespace formula {
inline double sin(double x) { return sine(x); }
inline double cos(double x) { return cosine(x); }
inline double atan(double x) { return arc_tangent(x); }
inline double atan2(double y, double x) { return arc_tangent2(y, x); }
inline double tanh(double x) { return hyperbolic_tangent(x); }
inline double exp(double x) { return exponential(x); }
inline double ln(double x) { return natural_logarithm(x); }
inline double is_zero(double x) { return x == 0 ? 1.0 : 0.0; }
}  // namespace formula

/// Those that would otherwise be of the C library. `Of<f>::call` is what the parser calls for f.
template <template <auto> class Of> void define_own_functions(mu::Parser& parser) {
  parser.DefineFun("sin", Of<&formula::sin>::call);
  parser.DefineFun("cos", Of<&formula::cos>::call);
  parser.DefineFun("tan", Of<&tangent>::call);
  parser.DefineFun("asin", Of<&arc_sine>::call);
  parser.DefineFun("acos", Of<&arc_cosine>::call);
  parser.DefineFun("atan", Of<&formula::atan>::call);
  parser.DefineFun("atan2", Of<&formula::atan2>::call);
  parser.DefineFun("sinh", Of<&hyperbolic_sine>::call);
  parser.DefineFun("cosh", Of<&hyperbolic_cosine>::call);
  parser.DefineFun("tanh", Of<&formula::tanh>::call);
  parser.DefineFun("asinh", Of<&area_sine>::call);
  parser.DefineFun("acosh", Of<&area_cosine>::call);
  parser.DefineFun("atanh", Of<&area_tangent>::call);
  parser.DefineFun("exp", Of<&formula::exp>::call);
  parser.DefineFun("ln", Of<&formula::ln>::call);
  parser.DefineFun("log", Of<&formula::ln>::call);
  parser.DefineFun("log2", Of<&binary_logarithm>::call);
  parser.DefineFun("log10", Of<&decimal_logarithm>::call);
  parser.DefineOprt(std::string(1, parsed_power), Of<&any_power>::call, mu::prPOW, mu::oaRIGHT, true);
  parser.DefineInfixOprt("!", Of<&formula::is_zero>::call);
}

/// The formula as it is passed to muParser.
inline std::string as_parsed(std::string text) {
  std::ranges::replace(text, written_power, parsed_power);
  return text;
}

}  // namespace loopwright
