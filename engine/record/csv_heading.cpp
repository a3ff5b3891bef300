/// Units in headings that are not in brackets: "x (mm)", "x/mm", "x, mm".
#include <algorithm>
#include <array>
#include <cctype>

#include "engine/json/unit_hint.h"
#include "engine/record/csv_syntax.h"
#include "engine/record/text.h"
#include "engine/unit/unit.h"

namespace loopwright::csv {
namespace {

template <size_t n> bool is_one_of(std::string_view text, const std::array<std::string_view, n>& list) {
  return std::ranges::find(list, text) != list.end();
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || (c & 0x80); }

/// Other single letters are rather names: udunits also knows b (barn), a (are), u and e.
constexpr std::string_view usual_letters = "mgsAVNWJKCFHTth%";

bool is_unit(std::string_view text) {
  if (text.empty() || !(is_letter(text.front()) || text == "%" || text.starts_with("1/"))) return false;
  if (std::ranges::count(text, '(') != std::ranges::count(text, ')')) return false;
  if (text.size() == 1 && usual_letters.find(text.front()) == usual_letters.npos) return false;
  return parse_unit(text) || unit_hint(text).find('*') != std::string::npos;
}

bool ends_with_time(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower == "t" || lower.ends_with("time") || lower.ends_with(" t") || lower.ends_with("_t");
}

}  // namespace

bool is_unit_of(std::string_view name, std::string_view unit) {
  return is_unit(unit) && (unit != "min" || ends_with_time(name));
}

namespace {

/// "F (N)", "F(N)". Without a blank, functions such as x(t) and max(F) remain names.
Heading in_parentheses(std::string_view text) {
  constexpr std::array<std::string_view, 18> functions = {"abs", "acos", "asin", "atan", "cos",  "diff",
                                                          "exp", "int",  "log",  "max",  "mean", "median",
                                                          "min", "rms",  "sin",  "sqrt", "std",  "tan"};
  const size_t open = text.rfind('(');
  if (!text.ends_with(')') || open == text.npos || open == 0) return {text, {}};
  const std::string_view before = text.substr(0, open), name = trim(before);
  const std::string_view unit = trim(text.substr(open + 1, text.size() - open - 2));
  const bool is_attached = name.size() == before.size();
  if (name.empty() || !is_unit_of(name, unit)) return {text, {}};
  if (is_attached && (unit == "t" || is_one_of(name, functions))) return {text, {}};
  return {name, unit};
}

/// "x/mm", "v/(m/s)" as in ISO 80000. Quotients such as km/h, m/s, N/A and dx/dt remain names.
Heading behind_slash(std::string_view text) {
  constexpr std::array<std::string_view, 9> symbols = {"N", "A", "V", "W", "J", "K", "C", "n", "k"};
  const size_t slash = text.find('/');
  if (slash == text.npos || slash == 0) return {text, {}};
  const std::string_view name = trim(text.substr(0, slash));
  std::string_view unit = trim(text.substr(slash + 1));
  const bool has_parentheses = unit.starts_with('(') && unit.ends_with(')');
  if (has_parentheses) unit = trim(unit.substr(1, unit.size() - 2));
  if (!has_parentheses && unit.find('/') != unit.npos) return {text, {}};
  if (name.empty() || name.find('(') != name.npos || !is_unit_of(name, unit) || unit == "t")
    return {text, {}};
  if (is_one_of(name, symbols) || (name.size() > 1 && parse_unit(name))) return {text, {}};
  if (name.starts_with('d') && unit.starts_with('d')) return {text, {}};
  if (const auto known = parse_unit(unit);
      name == "m" && !(known && known->same_dimension(*parse_unit("kg"))))
    return {text, {}};
  return {name, unit};
}

/// "Time, ms".
Heading behind_comma(std::string_view text) {
  const size_t comma = text.rfind(',');
  if (comma == text.npos || comma == 0) return {text, {}};
  const std::string_view name = trim(text.substr(0, comma)), unit = trim(text.substr(comma + 1));
  return !name.empty() && is_unit_of(name, unit) ? Heading{name, unit} : Heading{text, {}};
}

}  // namespace

Heading read_heading(std::string_view text) {
  if (text.ends_with(']')) {
    const Heading heading = split_heading(text);
    return heading.unit == "-" ? Heading{heading.name, "1"} : heading;
  }
  for (const auto notation : {behind_slash, in_parentheses, behind_comma})
    if (const Heading heading = notation(text); !heading.unit.empty()) return heading;
  return {text, {}};
}

}  // namespace loopwright::csv
