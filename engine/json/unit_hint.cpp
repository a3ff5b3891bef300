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
constexpr Alias aliases[] = {{"Nm", "N*m"},    {"mNm", "mN*m"}, {"Ns", "N*s"},       {"RPM", "rpm"},
                             {"U/min", "rpm"}, {"sec", "s"},    {"secs", "s"},       {"msec", "ms"},
                             {"usec", "us"},   {"Ohm", "ohm"},  {"°C", "degC"},      {"gram", "g"},
                             {"newton", "N"},  {"revs", "rpm"}, {"kgm^2", "kg*m^2"}, {"kgm2", "kg*m^2"},
                             {"Vs", "V*s"},    {"As", "A*s"},   {"micron", "um"}};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || (c & 0x80); }

std::string meant_by(const std::string& word) {
  const auto alias = std::ranges::find(aliases, word, &Alias::written);
  if (alias != std::end(aliases)) return std::string(alias->meant);
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
  std::string meant = meant_by(std::string(text));
  if (!meant.empty() && parse_unit(meant)) return fmt::format("did you mean \"{}\"?", meant);
  meant.clear();
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
  }
  return meant != text && parse_unit(meant) ? fmt::format("did you mean \"{}\"?", meant) : "";
}

}  // namespace loopwright
