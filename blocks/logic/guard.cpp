#include "blocks/logic/guard.h"
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"

namespace loopwright::blocks {
namespace {

std::string_view trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

std::optional<Unit> unit_of(const NamedNumber& constant) {
  if (constant.unit.empty()) return {};
  const auto unit = parse_unit(constant.unit);
  return unit ? std::optional(unit->in_si()) : std::nullopt;
}

const Unit& second() {
  static const Unit unit = parse_unit("s").value();
  return unit;
}

/// "0.5 s"; nothing if it is not a number with a unit.
std::optional<double> stated_duration(std::string_view text, size_t offset) {
  double number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (code != std::errc()) return {};
  const std::string_view rest = trimmed(text.substr(size_t(end - text.data())));
  if (rest.empty()) return number;
  const auto unit = is_name(rest.substr(0, 1)) ? parse_unit(rest) : std::nullopt;
  if (!unit) return {};
  if (!unit->same_dimension(second()))
    throw GuardError{"the duration is not a time", std::string(text), "as in after(0.5 s)", offset};
  return unit->to_si(number);
}

/// An expression over parameters, which is a time or has no unit at all.
double computed_duration(std::string_view text, const GuardNames& names, size_t offset) {
  std::vector<std::string_view> variables;
  std::vector<Quantity> quantities;
  for (const NamedNumber& constant : names.constants) {
    variables.push_back(constant.name);
    quantities.push_back({constant.value, unit_of(constant)});
  }
  for (const NameUse& use : names_in(text))
    if (std::ranges::find(names.inputs, use.name) != names.inputs.end())
      throw GuardError{"a duration depends on an input", std::string(text),
                       "a duration is a number with a unit, or an expression over parameters",
                       offset + use.offset};
  Formula formula;
  double half_turn = pi;
  try {
    formula.compile(std::string(text), variables, &half_turn);
  } catch (const mu::ParserError& error) {
    throw GuardError{"the duration cannot be read", FormulaParser::message_of(error), "as in after(0.5 s)",
                     offset};
  }
  const auto at = [&](const std::vector<double>& numbers, double pi_there) {
    std::ranges::copy(numbers, formula.variables.begin());
    half_turn = pi_there;
    return formula.parser.Eval();
  };
  std::vector<double> values;
  for (const Quantity& quantity : quantities) values.push_back(quantity.number);
  Unit unit;
  const UnitFinding finding = find_unit(at, quantities, unit);
  const bool has_unit = finding == UnitFinding::known && !unit.same_dimension(Unit{});
  if (finding == UnitFinding::mixed || finding == UnitFinding::mixed_turns ||
      (has_unit && !unit.same_dimension(second())))
    throw GuardError{"the duration is not a time", std::string(text), "as in after(0.5 s)", offset};
  return at(values, pi);
}

/// The parenthesis that closes the one at `open`; npos: there is none.
size_t closing(std::string_view text, size_t open) {
  int depth = 0;
  for (size_t at = open; at < text.size(); ++at) {
    depth += (text[at] == '(') - (text[at] == ')');
    if (depth == 0) return at;
  }
  return text.npos;
}

// Comparisons become operators that note both sides, so that their units can be compared.

thread_local std::vector<std::pair<double, double>> noted;
double note(double a, double b) {
  noted.emplace_back(a, b);
  return a;
}
double both(double a, double b) { return a + b; }

/// The formula with # for comparisons and $ for && and ||.
std::string with_notes(std::string_view text) {
  std::string result;
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at], next = at + 1 < text.size() ? text[at + 1] : ' ';
    const bool compares = c == '<' || c == '>' || ((c == '=' || c == '!') && next == '=');
    const bool joins = (c == '&' || c == '|') && next == c;
    if (compares || joins) {
      result += compares ? '#' : '$';
      if (next == '=' || joins) ++at;
    } else {
      result += c == '!' ? '-' : c;
    }
  }
  return result;
}

}  // namespace

std::vector<std::string_view> Guard::variables(const GuardNames& names) const {
  std::vector<std::string_view> all(names.inputs.begin(), names.inputs.end());
  for (const NamedNumber& constant : names.constants) all.push_back(constant.name);
  all.insert(all.end(), waiting_names_.begin(), waiting_names_.end());
  return all;
}

Guard::Guard(const std::string& text, const GuardNames& names) : text_(text) {
  if (trimmed(text).empty()) return;
  inputs_ = names.inputs.size(), constants_ = names.constants.size();
  std::vector<std::pair<size_t, size_t>> moved;  // positions in the formula, and in the text
  size_t copied = 0;
  for (const NameUse& use : names_in(text)) {
    const bool is_input = std::ranges::find(names.inputs, use.name) != names.inputs.end();
    if (use.offset < copied) continue;  // inside the last after(…)
    is_constant_ &= !is_input;
    if (!use.is_function || use.name != "after") continue;
    const size_t open = text.find('(', use.offset), close = closing(text, open);
    if (close == text.npos) throw GuardError{"a closing parenthesis is missing", text, "", open};
    const std::string_view inside = std::string_view(text).substr(open + 1, close - open - 1);
    const size_t offset = open + 1 + std::min(inside.find_first_not_of(' '), inside.size());
    const auto stated = stated_duration(trimmed(inside), offset);
    const double duration = stated ? *stated : computed_duration(trimmed(inside), names, offset);
    if (!(std::isfinite(duration) && duration >= 0))
      throw GuardError{"the duration is negative or not finite", fmt::format("{} s", duration), "", offset};
    durations_.push_back(duration);
    waiting_names_.push_back(fmt::format("_after{}", durations_.size()));
    moved.emplace_back(formula_text_.size() + use.offset - copied, use.offset);
    formula_text_ += text.substr(copied, use.offset - copied) + waiting_names_.back();
    copied = close + 1;
    moved.emplace_back(formula_text_.size(), copied);
  }
  formula_text_ += text.substr(copied);
  is_constant_ &= durations_.empty();
  try {
    formula_.compile(formula_text_, variables(names));
  } catch (const mu::ParserError& error) {
    GuardError wrong{"the guard cannot be read", FormulaParser::message_of(error), "", 0};
    const auto all = variables(names);
    for (size_t i = 0; i < inputs_ + constants_; ++i)
      wrong.hint += fmt::format("{}{}", i ? ", " : "it knows the names ", all[i]);
    size_t position = size_t(std::max(0, int(error.GetPos())));
    for (size_t i = moved.size(); i-- > 0;)
      if (position >= moved[i].first) {
        position = moved[i].second + (i % 2 ? position - moved[i].first : 0);
        break;
      }
    wrong.offset = std::min(position, text.size());
    throw wrong;
  }
  for (size_t i = 0; i < constants_; ++i) formula_.variables[inputs_ + i] = names.constants[i].value;
}

double Guard::value(double samples, double sample_time) const {
  if (formula_text_.empty()) return 1.0;
  // 3 times 0.1 s and 0.3 s differ by rounding: a duration that is missed by no more than that has passed.
  constexpr double rounding = 1 + 0x1p-50;
  for (size_t i = 0; i < durations_.size(); ++i)
    formula_.variables[inputs_ + constants_ + i] =
        samples * sample_time * rounding >= durations_[i] ? 1.0 : 0.0;
  return formula_.parser.Eval();
}

bool Guard::reads(const std::string& input) const {
  return std::ranges::any_of(names_in(formula_text_), [&](const NameUse& use) { return use.name == input; });
}

UnitFinding Guard::compare_units(std::span<const Unit> of_inputs, const GuardNames& names) const {
  if (formula_text_.empty()) return UnitFinding::known;
  std::vector<Quantity> arguments;
  for (const Unit& unit : of_inputs) arguments.push_back({1.0, unit});
  for (const NamedNumber& constant : names.constants)
    arguments.push_back({constant.value, unit_of(constant)});
  for (size_t i = 0; i < durations_.size(); ++i) arguments.push_back({1.0, {}});
  Formula noting;
  double half_turn = pi;
  try {
    noting.compile(with_notes(formula_text_), variables(names), &half_turn, [](FormulaParser& parser) {
      parser.DefineOprt("#", note, mu::prCMP, mu::oaLEFT, false);
      parser.DefineOprt("$", both, mu::prLAND, mu::oaLEFT, false);
    });
    noted.clear();
    noting.parser.Eval();
    const size_t comparisons = noted.size();
    for (size_t c = 0; c < comparisons; ++c) {
      Unit unit;
      const UnitFinding finding = find_unit(
          [&](const std::vector<double>& numbers, double pi_there) {
            std::ranges::copy(numbers, noting.variables.begin());
            half_turn = pi_there;
            noted.clear();
            noting.parser.Eval();
            return c < noted.size() ? noted[c].first - noted[c].second : 0.0;
          },
          arguments, unit);
      if (finding == UnitFinding::mixed || finding == UnitFinding::mixed_turns) return finding;
    }
  } catch (const mu::ParserError&) {  // reported when the guard was compiled
  }
  return UnitFinding::known;
}

}  // namespace loopwright::blocks
