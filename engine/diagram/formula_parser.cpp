#include "engine/diagram/formula_parser.h"

#include <algorithm>

#include "engine/diagram/formula_functions.h"

namespace loopwright {
namespace {

template <auto function> struct Itself { static constexpr auto call = function; };

}  // namespace

FormulaParser::FormulaParser() { define_own_functions<Itself>(*this); }

void FormulaParser::set_formula(const std::string& text) {
  if (const size_t at = text.find(parsed_power); at != text.npos)
    throw mu::ParserError(mu::ecUNASSIGNABLE_TOKEN, std::string(1, parsed_power), text, int(at));
  SetExpr(as_parsed(text));
}

std::string FormulaParser::message_of(const mu::ParserError& error) {
  std::string message = error.GetMsg();
  std::ranges::replace(message, parsed_power, written_power);
  return message;
}

}  // namespace loopwright
