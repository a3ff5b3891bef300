#include "tools/report/typography.h"
#include "models/real/whole.h"
#include <array>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace loopwright::report {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_power(char c) { return is_digit(c) || c == '-' || c == '.'; }

/// Removes `prefix` from the front of `text` if present.
bool skip(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// Removes the longest prefix of `text` whose characters all satisfy `belongs`.
template <class Predicate> std::string_view take_while(std::string_view& text, Predicate belongs) {
  const auto end = std::find_if_not(text.begin(), text.end(), belongs);
  const std::string_view front = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(front.size());
  return front;
}

std::string readable_symbol(std::string_view symbol) {
  if (symbol == "ohm" || symbol == "Ohm") return "Ω";
  if (symbol == "deg" || symbol == "degree") return "°";
  if (symbol == "percent") return "%";
  static constexpr std::string_view micro[] = {"um", "us", "uN", "uV", "uA", "urad", "uW", "uH", "uF", "ug"};
  if (std::find(std::begin(micro), std::end(micro), symbol) != std::end(micro))
    return "µ" + std::string(symbol.substr(1));
  return std::string(symbol);
}

std::string readable_power(std::string_view power) {
  static constexpr std::string_view superscript[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (power.empty() || power.find('.') != power.npos) return "^" + std::string(power);
  std::string out;
  for (const char c : power) out += c == '-' ? "⁻" : superscript[c - '0'];
  return out;
}

/// Removes a number, with its sign, from the front of `text` if present.
bool skip_number(std::string_view& text) {
  skip(text, "±") || skip(text, "+") || skip(text, "-") || skip(text, "−");
  if (skip(text, "nan") || skip(text, "inf") || skip(text, "∞")) return true;
  const std::string_view whole = take_while(text, is_digit);
  const std::string_view fraction = skip(text, ".") ? take_while(text, is_digit) : std::string_view{};
  if (whole.empty() && fraction.empty()) return false;
  std::string_view exponent = text;
  if (skip(exponent, "e") || skip(exponent, "E")) {
    skip(exponent, "-") || skip(exponent, "+");
    if (!take_while(exponent, is_digit).empty()) text = exponent;
  }
  return true;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '\0':
        out += "\uFFFD";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    // '<' is written as a number, so that neither "</script>" nor "<!--" can end or change the element.
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == '<')
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

std::string readable_unit(std::string_view unit) {
  if (unit == "1") return "";
  std::string out;
  while (!unit.empty()) {
    if (const std::string_view symbol = take_while(unit, is_letter); !symbol.empty()) {
      out += readable_symbol(symbol);
    } else if (skip(unit, "^") || skip(unit, "**")) {
      out += readable_power(take_while(unit, is_power));
    } else if (skip(unit, "*")) {
      out += "·";
    } else {
      out += unit.front();
      unit.remove_prefix(1);
    }
  }
  return out;
}

std::string with_unit(std::string_view label, std::string_view unit) {
  const std::string readable = readable_unit(unit);
  if (readable.empty()) return std::string(label);
  return label.empty() ? readable : fmt::format("{} ({})", label, readable);
}

bool is_numeric(std::string_view cell) {
  if (!skip_number(cell)) return false;
  std::string_view tolerance = cell;
  skip(tolerance, " ");
  if (skip(tolerance, "±")) {
    skip(tolerance, " ");
    if (skip_number(tolerance)) cell = tolerance;
  }
  // Only one short word may follow: the unit.
  return cell.empty() || cell == "%" || (skip(cell, " ") && cell.size() < 16 && cell.find(' ') == cell.npos);
}

std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 5) return digits;
  for (std::size_t i = digits.size() - 3; i < digits.size() && i > 0; i -= std::min<std::size_t>(i, 3))
    digits.insert(i, "\u202F");
  return digits;
}

int significant_digits(std::span<const double> values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double largest = std::max(std::abs(low), std::abs(high)), span = high - low;
  if (!(span > 0) || !std::isfinite(span)) return 7;
  return 7 + whole_between(std::ceil(std::log10(largest / span)), 0, 10);
}

std::size_t text_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

Quantity engineering(double value, std::string_view unit, int digits) {
  constexpr std::array<std::string_view, 9> prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
  constexpr std::array<std::string_view, 10> takes_prefix{"m", "N",  "V",  "A", "s",
                                                          "W", "Hz", "Pa", "J", "rad"};
  const std::string_view head = unit.substr(0, unit.find_first_of("*/^"));
  const bool is_power = head.size() < unit.size() && unit[head.size()] == '^';
  const bool fits = !is_power && std::ranges::find(takes_prefix, head) != takes_prefix.end();
  if (!fits || value == 0 || !std::isfinite(value))
    return {fmt::format("{:.{}g}", value, digits), readable_unit(unit)};
  // The prefix of the rounded number: 0.9998 with three digits is 1, not a thousand thousandths.
  const std::string rounded = fmt::format("{:.{}e}", value, digits - 1);
  const double exponent = std::strtod(rounded.c_str() + rounded.find('e') + 1, nullptr);
  const int step = whole_between(std::floor(exponent / 3), -4, head == "s" ? 0 : 4);
  return {fmt::format("{:.{}g}", std::strtod(rounded.c_str(), nullptr) / std::pow(1000.0, step), digits),
          std::string(prefixes[size_t(step + 4)]) + readable_unit(unit)};
}

std::string shown(double value, std::string_view unit, int digits) {
  const Quantity q = engineering(value, unit, digits);
  return q.unit.empty() ? q.value : q.value + " " + q.unit;
}

}  // namespace loopwright::report
