#include "tools/draw/shown_settings.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include "tools/report/typography.h"

namespace loopwright {
namespace {

/// The number at the start of a text, and what follows it.
std::pair<double, std::string_view> leading_number(std::string_view text) {
  double number = NAN;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return {NAN, text};
  return {number, text.substr(size_t(end - text.data()))};
}

std::string shortened(std::string_view text) {
  constexpr size_t most = 60;  // characters of one line
  if (text.size() <= most) return std::string(text);
  size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // whole characters
  return std::string(text.substr(0, end)) + " …";
}

}  // namespace

ShownSettings::ShownSettings(const BlockType& type, std::string path, const EffectiveSettings& effective,
                             std::function<std::string(std::string_view)> units)
    : type_(type), path_(std::move(path)), effective_(effective), units_(std::move(units)) {}

std::string_view ShownSettings::effective(std::string_view parameter) const {
  const auto found = effective_.find(path_ + '.' + std::string(parameter));
  return found == effective_.end() ? std::string_view() : found->second;
}

std::string ShownSettings::text(std::string_view parameter) const {
  std::string_view value = effective(parameter);
  if (value.size() >= 2 && value.front() == '"') value = value.substr(1, value.size() - 2);
  return std::string(value);
}

double ShownSettings::number(std::string_view parameter) const {
  return leading_number(effective(parameter)).first;
}

std::vector<double> ShownSettings::numbers(std::string_view parameter) const {
  std::string_view value = effective(parameter);
  std::vector<double> list;
  if (!value.starts_with('[')) return list;
  while (!value.empty() && value.front() != ']') {
    value.remove_prefix(1);
    const auto [number, rest] = leading_number(value);
    if (std::isnan(number)) return {};
    list.push_back(number);
    value = rest.substr(std::min(rest.find_first_of(",]"), rest.size()));
  }
  return list;
}

std::string ShownSettings::unit_of(std::string_view parameter, std::string_view rest) const {
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  if (!rest.empty()) return std::string(rest);
  const auto& parameters = type_.info.parameters;
  const auto info = std::ranges::find(parameters, parameter, &ParameterInfo::name);
  return info == parameters.end() ? std::string() : units_(info->unit);
}

std::string ShownSettings::quantity(std::string_view parameter) const {
  const auto [value, rest] = leading_number(effective(parameter));
  if (std::isnan(value)) return {};
  const report::Quantity shown = report::engineering(value, unit_of(parameter, rest));
  return shown.unit.empty() ? shown.value : shown.value + "\u202F" + shown.unit;
}

std::string ShownSettings::all() const {
  std::string lines;
  for (const ParameterInfo& parameter : type_.info.parameters) {
    const std::string number = quantity(parameter.name);
    const std::string_view value = effective(parameter.name);
    if (value.empty()) continue;
    lines += fmt::format("{}{} = {}", lines.empty() ? "" : "\n", parameter.name,
                         number.empty() ? shortened(text(parameter.name)) : number);
  }
  return lines;
}

}  // namespace loopwright
