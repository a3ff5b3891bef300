#include "engine/diagram/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <unordered_map>
#include "engine/diagram/formula_parser.h"
#include "engine/unit/scaled_rate.h"

namespace loopwright {
namespace {

constexpr size_t longest_expression = 1000;  // characters; limits the work for hostile input

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// The end of a number such as 1.5e-3, so that its e is not read as a name.
size_t end_of_number(std::string_view text, size_t at) {
  const auto skip_digits = [text](size_t i) {
    while (i < text.size() && is_digit(text[i])) ++i;
    return i;
  };
  at = skip_digits(at);
  if (at < text.size() && text[at] == '.') at = skip_digits(at + 1);
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const size_t sign = at + 1 < text.size() && (text[at + 1] == '+' || text[at + 1] == '-') ? 1 : 0;
    const size_t end = skip_digits(at + 1 + sign);
    if (end > at + 1 + sign) return end;
  }
  return at;
}

/// muParser's '=' would assign to a parameter.
size_t find_assignment(std::string_view text) {
  for (size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '=') continue;
    const bool is_comparison =
        (at > 0 && std::string_view("<>!=").find(text[at - 1]) != std::string_view::npos) ||
        (at + 1 < text.size() && text[at + 1] == '=');
    if (!is_comparison) return at;
  }
  return std::string_view::npos;
}

/// The first character that is not allowed in an expression; npos: none.
size_t find_foreign(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = is_digit(text[at]) || text[at] == '.' ? end_of_number(text, at) : at;
    const bool is_lone_point = text[at] == '.' && end == at + 1;
    if (end > at && !is_lone_point)
      at = end;
    else if (is_letter(text[at]) ||
             std::string_view("+-*/^()<>=!&|?:, ").find(text[at]) != std::string_view::npos)
      ++at;
    else
      return at;
  }
  return std::string_view::npos;
}

std::string plain_words(const mu::ParserError& error) {
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends too early";
    case mu::ecMISSING_PARENS:
      return "a closing parenthesis is missing";
    case mu::ecUNEXPECTED_PARENS:
      return "a parenthesis stands at a wrong place";
    case mu::ecTOO_MANY_PARAMS:
      return "a function has too many arguments";
    case mu::ecTOO_FEW_PARAMS:
      return "a function has too few arguments";
    case mu::ecUNEXPECTED_ARG_SEP:
    case mu::ecUNEXPECTED_ARG:
      return "a comma stands at a wrong place";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "an operator is missing";
    case mu::ecUNEXPECTED_OPERATOR:
      return "an operator stands at a wrong place";
    case mu::ecUNEXPECTED_CONDITIONAL:
    case mu::ecMISSING_ELSE_CLAUSE:
    case mu::ecMISPLACED_COLON:
      return "a condition is not of the form a ? b : c";
    default:
      return "the expression cannot be read";
  }
}

/// An expression compiled by muParser, with storage for the numbers of its parameters.
class Compiled {
 public:
  /// If π varies, products with it are not folded: the last bits of a result may differ.
  enum class Pi { is_constant, varies };
  Compiled(std::string_view expression, const std::vector<std::string>& names, Pi pi = Pi::is_constant)
      : parser_(parser(pi)), numbers_(names.size()) {
    parser_.ClearVar();
    for (size_t i = 0; i < names.size(); ++i) parser_.DefineVar(names[i], &numbers_[i]);
    if (pi == Pi::varies) parser_.DefineVar("pi", &pi_);
    parser_.set_formula(std::string(expression));
  }
  ~Compiled() { parser_.ClearVar(); }
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;

  /// Throws mu::ParserError when the expression cannot be read.
  double operator()(const std::vector<double>& numbers, double pi = std::numbers::pi) {
    std::ranges::copy(numbers, numbers_.begin());
    pi_ = pi;
    int results = 0;
    const double* values = parser_.Eval(results);
    if (results != 1) throw mu::ParserError(mu::ecUNEXPECTED_ARG_SEP);
    return values[0];
  }

  static bool has_function(std::string_view name) {
    return parser(Pi::is_constant).GetFunDef().contains(std::string(name));
  }
  static std::vector<std::string> functions() {
    std::vector<std::string> names;
    for (const auto& [name, function] : parser(Pi::is_constant).GetFunDef()) names.push_back(name);
    return names;
  }

 private:
  /// Creating a parser costs far more than using it.
  static FormulaParser& parser(Pi pi) {
    thread_local FormulaParser with_constant = make_parser(Pi::is_constant),
                               with_variable = make_parser(Pi::varies);
    return pi == Pi::is_constant ? with_constant : with_variable;
  }
  static FormulaParser make_parser(Pi pi) {
    FormulaParser parser;
    if (pi == Pi::is_constant) parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    return parser;
  }

  FormulaParser& parser_;
  std::vector<double> numbers_;
  double pi_ = std::numbers::pi;
};

// ---- Messages
// --------------------------------------------------------------------------------------------------

class Evaluator {
 public:
  Evaluator(std::string_view expression, const ExpressionSite& site, Problems& problems)
      : expression_(expression), site_(site), problems_(problems) {}

  std::optional<Quantity> run() {
    if (!is_readable() || !find_names()) return {};
    if (names_.size() == 1 && uses_.size() == 1 && trimmed() == names_[0]) return parameters_[0];
    try {
      return value_with_unit();
    } catch (const mu::ParserError& error) {
      report(plain_words(error), static_cast<size_t>(std::max(error.GetPos(), 0)));
    } catch (const std::exception&) {  // muParser passes some exceptions of the standard library through
      report("the expression cannot be read", 0);
    }
    return {};
  }

 private:
  Place place_of(size_t offset) const {
    Place place = site_.place;
    constexpr size_t quote_and_equals = 2;
    // If the text has escapes, offsets in the file differ from those in the expression.
    const bool stands_there =
        place.file && std::string_view(place.file->text)
                          .substr(std::min<size_t>(place.offset, place.file->text.size()))
                          .substr(0, expression_.size() + quote_and_equals)
                          .ends_with(expression_);
    if (stands_there)
      place.offset += static_cast<uint32_t>(quote_and_equals + std::min(offset, expression_.size()));
    return place;
  }

  Problem& report(std::string message, size_t offset) {
    Problem& problem =
        problems_.error(place_of(offset), site_.place.pointer(), site_.block, std::move(message));
    problem.found = fmt::format("={}", expression_.substr(0, 200));
    return problem;
  }

  std::string_view trimmed() const {
    const size_t begin = std::min(expression_.find_first_not_of(' '), expression_.size());
    return expression_.substr(begin, expression_.find_last_not_of(' ') + 1 - begin);
  }

  bool is_readable() {
    if (expression_.size() > longest_expression) {
      report(fmt::format("an expression is longer than {} characters", longest_expression), 0).found.clear();
      return false;
    }
    if (trimmed().empty()) {
      report("the expression is empty", 0).expected = "an expression after '=', as in \"=2*pi*40\"";
      return false;
    }
    if (const size_t at = find_foreign(expression_); at != expression_.npos) {
      Problem& problem = report("a character has no meaning in an expression", at);
      if (expression_[at] == '.')
        problem.hint = "an expression uses the \"parameters\" of its own diagram, which have no dots";
      return false;
    }
    if (const size_t at = find_assignment(expression_); at != expression_.npos) {
      report("an expression cannot assign", at).hint = "== compares";
      return false;
    }
    return true;
  }

  bool find_names() {
    uses_ = names_in(expression_);
    bool all_known = true;
    for (const NameUse& use : uses_) {
      if (use.is_function) {
        all_known &= is_function(use);
        continue;
      }
      if (std::ranges::find(names_, use.name) != names_.end()) continue;
      const Quantity* quantity = site_.lookup(use, place_of(use.offset));
      all_known &= quantity != nullptr;
      names_.emplace_back(use.name);
      parameters_.push_back(quantity ? *quantity : Quantity{});
    }
    return all_known;
  }

  bool is_function(const NameUse& use) {
    if (Compiled::has_function(use.name)) return true;
    Problem& problem = report(fmt::format("there is no function \"{}\"", use.name), use.offset);
    const std::string near = nearest_name(use.name, Compiled::functions());
    if (!near.empty()) problem.hint = fmt::format("did you mean \"{}\"?", near);
    return false;
  }

  std::optional<Quantity> value_with_unit() {
    std::vector<double> numbers;
    for (const Quantity& parameter : parameters_) numbers.push_back(parameter.number);
    Quantity result{Compiled(expression_, names_)(numbers), {}};
    if (!std::isfinite(result.number)) {
      Problem& problem = report("the result of the expression is not a finite number", 0);
      problem.found += fmt::format(", which is {}{}", result.number, with_values());
      return {};
    }
    const bool has_units =
        std::ranges::any_of(parameters_, [](const Quantity& p) { return p.unit.has_value(); });
    if (!has_units) return result;
    Unit unit;
    Compiled f(expression_, names_, Compiled::Pi::varies);
    const UnitFinding finding =
        find_unit([&f](const std::vector<double>& at, double pi) { return f(at, pi); }, parameters_, unit);
    if (finding == UnitFinding::known) result.unit = unit;
    const bool is_turns_over_hertz = finding == UnitFinding::known && unit.cycles() == -2;
    if (finding == UnitFinding::zero || (finding == UnitFinding::known && !is_turns_over_hertz))
      return result;  // zero fits every unit
    const bool has_rate =
        std::ranges::any_of(parameters_, [](const Quantity& p) { return p.unit && is_scaled_rate(*p.unit); });
    Problem& problem =
        report(is_turns_over_hertz ? "2*pi over a frequency in Hz is neither a period nor a time constant"
               : finding == UnitFinding::mixed ? "the expression mixes units"
               : finding == UnitFinding::mixed_turns && has_rate
                   ? "the expression adds a rate such as 1/min to rad/s or Hz"
               : finding == UnitFinding::mixed_turns ? "the expression adds Hz and rad/s"
                                                     : "the unit of the expression cannot be found",
               0);
    problem.found += with_units();
    if (finding == UnitFinding::mixed_turns)
      problem.hint = has_rate ? "revolutions per minute are rpm" : "2*pi times a frequency in Hz is in rad/s";
    if (is_turns_over_hertz)
      problem.hint = "the period of f is 1/f, the time constant of a corner at f is 1/(2*pi*f)";
    if (finding == UnitFinding::mixed)
      problem.hint = "a number can be given a unit as a parameter: {\"value\": 3, \"unit\": \"m\"}";
    return {};
  }

  std::string with_values() const {
    std::string text;
    for (size_t i = 0; i < names_.size(); ++i)
      text += fmt::format("{} {} = {}", i == 0 ? " with" : ",", names_[i], parameters_[i].number);
    return text;
  }

  std::string with_units() const {
    std::string text = " with";
    for (size_t i = 0; i < names_.size(); ++i) {
      const std::string unit = parameters_[i].unit ? "in " + to_string(*parameters_[i].unit) : "without unit";
      text += fmt::format("{} {} {}", i == 0 ? "" : ",", names_[i], unit);
    }
    return text;
  }

  std::string_view expression_;
  const ExpressionSite& site_;
  Problems& problems_;
  std::vector<NameUse> uses_;
  std::vector<std::string> names_;  // of the parameters, each once
  std::vector<Quantity> parameters_;
};

}  // namespace

bool is_constant_name(std::string_view name) { return name == "pi" || name == "e"; }

std::vector<NameUse> names_in(std::string_view expression) {
  std::vector<NameUse> uses;
  for (size_t at = 0; at < expression.size();) {
    const char c = expression[at];
    if (is_digit(c) || (c == '.' && at + 1 < expression.size() && is_digit(expression[at + 1]))) {
      at = end_of_number(expression, at);
      continue;
    }
    if (!is_letter(c)) {
      ++at;
      continue;
    }
    const size_t begin = at;
    while (at < expression.size() && (is_letter(expression[at]) || is_digit(expression[at]))) ++at;
    const std::string_view name = expression.substr(begin, at - begin);
    const size_t next = std::min(expression.find_first_not_of(' ', at), expression.size());
    const bool is_function = next < expression.size() && expression[next] == '(';
    if (is_function || !is_constant_name(name)) uses.push_back({name, begin, is_function});
  }
  return uses;
}

std::optional<Quantity> evaluate(std::string_view expression, const ExpressionSite& site,
                                 Problems& problems) {
  return Evaluator(expression, site, problems).run();
}

}  // namespace loopwright
