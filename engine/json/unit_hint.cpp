#include "engine/json/unit_hint.h"
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <vector>
#include "engine/json/problem.h"
#include "engine/unit/unit.h"

namespace loopwright {
namespace {

/// Usual units in motion control; of two that differ only in case the more likely one comes first.
const std::vector<std::string>& usual_units() {
  static const std::vector<std::string> units{
      "m",   "mm", "um",   "nm",   "km", "kg",  "g",    "N",   "mN",     "kN",  "V",   "mV",
      "A",   "mA", "s",    "ms",   "us", "min", "h",    "Hz",  "kHz",    "rad", "deg", "mrad",
      "rpm", "K",  "degC", "degF", "J",  "W",   "kW",   "Pa",  "bar",    "T",   "Wb",  "H",
      "mH",  "F",  "uF",   "ohm",  "C",  "1",   "inch", "lbf", "percent"};
  return units;
}

/// Common notations that are not explained by a misspelling.
struct Alias {
  std::string_view written, meant;
};
constexpr Alias aliases[] = {{"U/min", "rpm"},     {"revs", "rpm"},     {"RPM", "rpm"},    {"RPS", "rps"},
                             {"sec", "s"},         {"secs", "s"},       {"msec", "ms"},    {"usec", "us"},
                             {"rads", "rad"},      {"Ohm", "ohm"},      {"°C", "degC"},    {"gram", "g"},
                             {"newton", "N"},      {"micron", "um"},    {"NM", "N*m"},     {"cts", "count"},
                             {"ticks", "count"},   {"/s", "1/s"},       {"/min", "1/min"}, {"kgs", "kg"},
                             {"ozin", "ozf*inch"}, {"kgm^2", "kg*m^2"}, {"kgm2", "kg*m^2"}};

/// Units of which products are often written without a sign: "Nm", "kgcm2", "Vs".
constexpr std::string_view first_factors[] = {"mN", "uN", "kN", "N",  "mV", "V",  "mA",
                                              "A",  "kW", "W",  "kg", "g",  "lbf"};
constexpr std::string_view other_factors[] = {"mm", "cm", "m", "s", "h", "in", "ft"};

/// "N*m*s" for "Nms"; empty if the word is not such a product.
std::string with_signs(std::string_view word) {
  const auto rest_of = [](const auto& self, std::string_view rest) -> std::string {
    if (rest.empty()) return " ";
    for (const std::string_view factor : other_factors)
      if (rest.starts_with(factor))
        if (const std::string more = self(self, rest.substr(factor.size())); !more.empty())
          return "*" + std::string(factor) + more;
    return "";
  };
  for (const std::string_view factor : first_factors) {
    if (!word.starts_with(factor) || word.size() == factor.size()) continue;
    std::string rest = rest_of(rest_of, word.substr(factor.size()));
    if (rest.empty()) continue;
    rest.pop_back();
    return std::string(factor) + rest;
  }
  return "";
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || (c & 0x80); }

std::string meant_by(const std::string& word) {
  const auto alias = std::ranges::find(aliases, word, &Alias::written);
  if (alias != std::end(aliases)) return std::string(alias->meant);
  if (std::string product = with_signs(word); !product.empty()) return product;
  const auto lower = [](std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  for (const std::string& unit : usual_units())
    if (lower(unit) == lower(word)) return unit;
  return nearest_name(word, usual_units());
}

}  // namespace

std::string unit_hint(std::string_view text) {
  constexpr size_t longest = 64;  // of a text that may be a unit
  if (text.size() > longest) return "";
  const bool is_word = std::ranges::all_of(text, is_letter);
  const auto alias = std::ranges::find(aliases, text, &Alias::written);
  if (is_word || alias != std::end(aliases)) {
    const std::string meant = meant_by(std::string(text));
    return !meant.empty() && parse_unit(meant) ? fmt::format("did you mean \"{}\"?", meant) : "";
  }
  std::string meant;
  for (size_t at = 0; at < text.size();) {  // word by word
    size_t end = at;
    while (end < text.size() && is_letter(text[end])) ++end;
    const std::string word(text.substr(at, end - at));
    if (word.empty()) {
      meant += text[at++];
      continue;
    }
    const std::string other = parse_unit(word) ? word : meant_by(word);
    if (other.empty()) return "";
    meant += other;
    at = end;
    if (at < text.size() && other != word && std::isdigit(static_cast<unsigned char>(text[at]))) meant += '^';
  }
  return meant != text && parse_unit(meant) ? fmt::format("did you mean \"{}\"?", meant) : "";
}

}  // namespace loopwright
