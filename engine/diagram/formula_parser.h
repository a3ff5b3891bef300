#pragma once
#include <muParser.h>
#include <string>

namespace loopwright {

/// muParser with the functions of models/real and its own power function. muParser would call the C library,
/// whose bits differ between processors. `!` is the logical not. Everything else is unchanged muParser.
class FormulaParser : public mu::Parser {
 public:
  FormulaParser();
  /// Replaces SetExpr. Throws mu::ParserError, as Eval does.
  void set_formula(const std::string& text);
  /// The message of muParser about a formula, with the operators as they were written.
  static std::string message_of(const mu::ParserError& error);
};

}  // namespace loopwright
