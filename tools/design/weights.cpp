#include "tools/design/weights.h"
#include <fmt/format.h>
#include <charconv>
#include <cmath>

namespace loopwright {
namespace {

std::optional<StatedNumber> number_of(const std::string& text) {
  if (auto with_unit = number_and_unit(text)) return with_unit;
  StatedNumber bare;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bare.number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(bare.number)) return {};
  bare.at.kind = Value::Kind::number, bare.at.number = bare.number;
  return bare;
}

}  // namespace

std::vector<NamedNumber> named_numbers(const std::vector<std::string>& texts, std::string_view option,
                                       Problems& problems) {
  std::vector<NamedNumber> result;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    const auto number = equals == text.npos ? std::nullopt : number_of(text.substr(equals + 1));
    if (!number || equals == 0) {
      auto& p =
          problems.error({}, "", "", fmt::format("{}: \"{}\" is not a name and a number", option, text));
      p.expected = "NAME=NUMBER or \"NAME=NUMBER UNIT\"";
      continue;
    }
    result.push_back({text.substr(0, equals), text.substr(equals + 1), *number, std::string(option)});
    for (size_t i = 0; i + 1 < result.size(); ++i)
      if (result[i].name == result.back().name)
        problems.error({}, "", "", fmt::format("{} names \"{}\" twice", option, result[i].name));
  }
  return result;
}

double number_for(const NamedNumber& named, const std::optional<Unit>& signal, double exponent,
                  double seconds, Problems& problems) {
  const std::string what = fmt::format("{} of \"{}\"", named.option, named.name);
  const Reader reader{problems, ""};
  if (named.number.unit && !signal) {
    auto& p = problems.error({}, "", "", what + " has a unit, but the unit of the signal is not known");
    p.found = named.text, p.hint = "state the number in SI, without a unit";
    return 0;
  }
  const Unit second{1.0, {0, 0, 1}};
  const Unit unit = signal ? power(signal->in_si(), exponent) * power(second, seconds) : Unit{};
  const double number = signal ? in_unit(named.number, unit, what, reader).value_or(0) : named.number.number;
  if (number >= 0) return number;
  problems.error({}, "", "", what + " is negative").found = named.text;
  return 0;
}

}  // namespace loopwright
