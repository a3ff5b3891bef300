/// y = formula(names[0], names[1], …)
///
/// The formula may also use the parameters of the diagram that contains the block, with their units; a name
/// in `names` hides a parameter of the same name. A parameter without a unit is a plain number.
///
/// The formula is read by muParser, and computed as the list of what it would execute: + - * / ^,
/// comparisons, && || !, c ? a : b, sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, ln, log2,
/// log10, sqrt, abs, sign, rint, min, max, sum, avg; `pi`, and `_e` for Euler's number. Units are checked as
/// in the expression of a parameter; π is a half cycle in radians. A variable-step solver does not locate the
/// kinks and jumps of the formula; where that matters, use blocks instead. An infinite or NaN result stops
/// the run.
#include <fmt/format.h>
#include <algorithm>
#include "blocks/math/formula.h"

namespace loopwright::blocks {

struct Expression {
  std::string formula;
  std::vector<std::string> names;
  std::vector<NamedNumber> constants;
  mutable Formula compiled;  // belongs to one run: it has its own evaluation stack
  struct In {
    Many<double> arguments;
  };
  struct Out {
    double y;
  };
  static constexpr auto describe() {
    return block(
        "A formula over any number of signals.",
        parameter(&Expression::formula, "formula", "", "The formula, as in \"k * sin(2*pi*x)\""),
        parameter(&Expression::names, "names", "", "What the formula calls its arguments, in their order"),
        parameter(&Expression::constants, "constants", "",
                  "Further numbers; parameters of the diagram in the formula are added by themselves")
            .optional(),
        input(&In::arguments, "arguments", "?", "A signal for each name").length(&Expression::arguments),
        output(&Out::y, "y", "$y", "What the formula gives"));
  }
  int arguments() const { return int(names.size()); }
  /// Arguments, then constants.
  std::vector<std::string_view> all_names() const {
    std::vector<std::string_view> all(names.begin(), names.end());
    for (const NamedNumber& constant : constants) all.push_back(constant.name);
    return all;
  }
  void check(const Checker& checker) const {
    const auto all = all_names();
    bool are_different = true;
    for (size_t i = 0; i < all.size(); ++i)
      if (std::find(all.begin(), all.begin() + ptrdiff_t(i), all[i]) != all.begin() + ptrdiff_t(i)) {
        const bool is_argument = i < names.size();
        checker
            .error(is_argument ? "names" : "constants",
                   is_argument ? "two arguments have the same name" : "the name is already in use")
            .found = fmt::format("\"{}\"", all[i]);
        are_different = false;
      }
    for (const NamedNumber& constant : constants)
      if (!constant.unit.empty() && !parse_unit(constant.unit)) {
        checker.error("constants", "there is no such unit").found = "\"" + constant.unit + "\"";
        are_different = false;
      }
    if (!are_different) return;
    try {
      Formula().compile(formula, all);
    } catch (const mu::ParserError& error) {
      const bool in_name = error.GetCode() == mu::ecINVALID_NAME || error.GetCode() == mu::ecNAME_CONFLICT;
      auto& p =
          checker.error(in_name ? "names" : "formula",
                        in_name ? "this cannot be the name of an argument" : "the formula cannot be read");
      if (!in_name && error.GetPos() >= 0) p.place.offset += 1 + uint32_t(error.GetPos());  // after the quote
      p.found = FormulaParser::message_of(error);
      for (const std::string_view name : all)
        p.hint.append(p.hint.empty() ? "it knows the names " : ", ").append(name);
    }
  }
  FormulaUnit formula_unit(std::span<const Unit> of_wires) const {
    FormulaUnit result;
    result.parameter = "formula";
    if (of_wires.size() != names.size()) return result;  // reported by the check of shapes
    std::vector<Quantity> arguments;
    for (size_t i = 0; i < of_wires.size(); ++i) {
      arguments.push_back({1.0, of_wires[i]});
      result.found += (i ? ", " : formula + " with ") + names[i] + " in " + to_string(of_wires[i]);
    }
    for (const NamedNumber& constant : constants) {
      const auto unit = constant.unit.empty() ? std::nullopt : parse_unit(constant.unit);
      arguments.push_back({constant.value, unit ? std::optional(unit->in_si()) : std::nullopt});
      if (unit)
        result.found += fmt::format("{}{} in {}", of_wires.empty() ? formula + " with " : ", ", constant.name,
                                    to_string(*unit));
    }
    double half_turn = pi;
    Formula rescaled;
    const auto at = [&](const std::vector<double>& numbers, double pi_there) {
      std::ranges::copy(numbers, rescaled.variables.begin());
      half_turn = pi_there;
      return rescaled.parser.Eval();
    };
    try {
      rescaled.compile(formula, all_names(), &half_turn);
      result.finding = find_unit(at, arguments, result.unit);
    } catch (const mu::ParserError&) {  // reported by check
    }
    return result;
  }
  void prepare(double) {
    if (!compiled.is_compiled)
      compiled.compile(formula, all_names()), compiled.compute_in_steps(formula, all_names());
    for (size_t i = 0; i < constants.size(); ++i) compiled.arguments()[names.size() + i] = constants[i].value;
    compiled.keep_constant_from(names.size());
  }
  Fault outputs(const In& in, Out& out) const {
    double* const arguments = compiled.arguments().data();
    for (int i = 0; i < in.arguments.size(); ++i) arguments[i] = in.arguments[i];
    out.y = compiled.value();
    return fault_if(!std::isfinite(out.y), "the formula gave a non-finite number");
  }
};
LOOPWRIGHT_BLOCK(Expression)

}  // namespace loopwright::blocks
