#pragma once
#include <muParser.h>
#include <string>

namespace loopwright {

/// muParser with the functions of models/real and powers of our own: those of the C library, which it would
/// call, have other bits on other processors. Everything else is as muParser has it.
class FormulaParser : public mu::Parser {
 public:
  FormulaParser();
  /// Takes the place of SetExpr. Throws mu::ParserError, as Eval does.
  void set_formula(const std::string& text);
  /// What muParser says about a formula, with its operators as they were written.
  static std::string message_of(const mu::ParserError& error);
};

}  // namespace loopwright
