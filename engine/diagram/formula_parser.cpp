#include "engine/diagram/formula_parser.h"

#include <algorithm>

#include "models/real/double_functions.h"

namespace loopwright {
namespace {

/// muParser does not allow its ^ to be replaced. Formulas are therefore passed to it with an operator that it
/// does not define.
constexpr char written_power = '^', parsed_power = '~';

}  // namespace

FormulaParser::FormulaParser() {
  DefineFun("sin", [](double x) { return sine(x); });
  DefineFun("cos", [](double x) { return cosine(x); });
  DefineFun("tan", tangent);
  DefineFun("asin", arc_sine);
  DefineFun("acos", arc_cosine);
  DefineFun("atan", [](double x) { return arc_tangent(x); });
  DefineFun("atan2", [](double y, double x) { return arc_tangent2(y, x); });
  DefineFun("sinh", hyperbolic_sine);
  DefineFun("cosh", hyperbolic_cosine);
  DefineFun("tanh", [](double x) { return hyperbolic_tangent(x); });
  DefineFun("asinh", area_sine);
  DefineFun("acosh", area_cosine);
  DefineFun("atanh", area_tangent);
  DefineFun("exp", [](double x) { return exponential(x); });
  DefineFun("ln", [](double x) { return natural_logarithm(x); });
  DefineFun("log", [](double x) { return natural_logarithm(x); });
  DefineFun("log2", binary_logarithm);
  DefineFun("log10", decimal_logarithm);
  DefineOprt(std::string(1, parsed_power), any_power, mu::prPOW, mu::oaRIGHT, true);
  DefineInfixOprt("!", [](double x) { return x == 0 ? 1.0 : 0.0; });
}

void FormulaParser::set_formula(const std::string& text) {
  if (const size_t at = text.find(parsed_power); at != text.npos)
    throw mu::ParserError(mu::ecUNASSIGNABLE_TOKEN, std::string(1, parsed_power), text, int(at));
  std::string parsed = text;
  std::ranges::replace(parsed, written_power, parsed_power);
  SetExpr(parsed);
}

std::string FormulaParser::message_of(const mu::ParserError& error) {
  std::string message = error.GetMsg();
  std::ranges::replace(message, parsed_power, written_power);
  return message;
}

}  // namespace loopwright
