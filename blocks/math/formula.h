/// Formulas over signals and parameters, as in `Expression` and in the guards of a `StateMachine`.
#pragma once
#include "engine/block.h"
#include "engine/diagram/formula_parser.h"
#include "engine/diagram/formula_steps.h"

namespace loopwright::blocks {

/// A compiled formula with storage for its variables. A copy is empty, as the compiled code points to its own
/// variables.
struct Formula {
  FormulaParser parser;
  std::vector<double> variables;
  bool is_compiled = false;
  std::optional<FormulaSteps> steps;  ///< the same, several times faster, after compute_in_steps
  Formula() = default;
  Formula(const Formula&) {}
  Formula& operator=(const Formula&) { return *this; }

  /// Throws mu::ParserError. `half_turn` replaces π, to determine its effect on the result. `extend` may add
  /// operators to the parser.
  void compile(const std::string& text, const std::vector<std::string_view>& names,
               double* half_turn = nullptr, void (*extend)(FormulaParser&) = nullptr) {
    parser = FormulaParser();
    if (extend) extend(parser);
    if (half_turn)
      parser.DefineVar("pi", half_turn);
    else
      parser.DefineConst("pi", pi);
    variables.assign(names.size(), 1.0);
    for (size_t i = 0; i < names.size(); ++i) parser.DefineVar(std::string(names[i]), &variables[i]);
    parser.set_formula(text);
    parser.Eval();  // compiles the formula, so that later calls do not allocate
    steps.reset(), is_compiled = true;
  }
  /// Of a compiled formula.
  void compute_in_steps(const std::string& text, const std::vector<std::string_view>& names) {
    steps = FormulaSteps::of(text, names);
  }
  /// From this variable on they stay as they are.
  void keep_constant_from(size_t first) {
    if (steps) steps->keep_constant_from(first);
  }
  /// Where the values of the variables are written.
  std::span<double> arguments() { return steps ? steps->variables() : std::span(variables); }
  double value() { return steps ? steps->value() : parser.Eval(); }
};

/// A parameter of the diagram that a formula names.
struct NamedNumber {
  std::string name;
  double value = 0;
  std::string unit;
  static constexpr auto describe() {
    return fields(
        parameter(&NamedNumber::name, "name", "", "What the formula calls it"),
        parameter(&NamedNumber::value, "value", "", "The number, in SI"),
        parameter(&NamedNumber::unit, "unit", "", "Its unit; a plain number when empty").optional());
  }
};

}  // namespace loopwright::blocks
