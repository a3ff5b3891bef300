#include "engine/unit/unit.h"
#include "engine/unit/base_symbols.h"
#include "engine/unit/scaled_rate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <unordered_map>
#include <vector>
#include <udunits2.h>
#include "models/real/double_functions.h"

namespace loopwright {
namespace {

using Exponents = decltype(Unit::exponents);

/// Rounds sums of exponents to a multiple of 1/12, so that equal dimensions compare equal.
float exact_exponent(double exponent) { return static_cast<float>(std::round(exponent * 12) / 12); }

// ---- udunits2
// ------------------------------------------------------------------------------------------------

/// Collects the powers of base units during a traversal by udunits; rejects units that are not scale ·
/// product.
struct Collector {
  Unit unit;
  bool has_offset = false;

  static int base_index(const ut_unit* base) {
    const char* symbol = ut_get_symbol(base, UT_UTF8);
    for (size_t i = 0; symbol && i < base_symbols.size(); ++i)
      if (symbol == base_symbols[i]) return static_cast<int>(i);
    return -1;
  }

  static ut_status multiply(const ut_unit* base, int power, void* self) {
    const int i = base_index(base);
    if (i >= 0) static_cast<Collector*>(self)->unit.exponents[i] += static_cast<float>(power);
    return UT_SUCCESS;
  }
  static ut_status visit_base(const ut_unit* base, void* self) { return multiply(base, 1, self); }
  static ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers,
                                 void* self) {
    for (int i = 0; i < count; ++i) multiply(bases[i], powers[i], self);
    return UT_SUCCESS;
  }
  static ut_status visit_scaled(const ut_unit*, double scale, const ut_unit* underlying, double offset,
                                void* self) {
    static_cast<Collector*>(self)->unit.scale *= scale;
    static_cast<Collector*>(self)->has_offset |= offset != 0;
    return ut_accept_visitor(underlying, &visitor, self);
  }
  static ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void*) { return UT_MEANINGLESS; }
  static ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void*) { return UT_MEANINGLESS; }

  static constexpr ut_visitor visitor = {visit_base, visit_product, visit_scaled, visit_timestamp,
                                         visit_logarithmic};
};

/// For udunits2, Hz is 1/s, which also means a radian per second. Here it counts cycles.
void make_hertz_count_cycles(ut_system* system) {
  ut_unmap_name_to_unit(system, "hertz", UT_UTF8);
  ut_unmap_symbol_to_unit(system, "Hz", UT_UTF8);
  ut_unit* const cycle = ut_new_base_unit(system);
  ut_map_unit_to_symbol(cycle, std::string(cycle_symbol).c_str(), UT_UTF8);
  ut_unit* const second = ut_parse(system, "s", UT_UTF8);
  ut_unit* const hertz = ut_divide(cycle, second);
  ut_map_name_to_unit("hertz", UT_UTF8, hertz);
  ut_map_symbol_to_unit("Hz", UT_UTF8, hertz);
  for (ut_unit* unit : {cycle, second, hertz}) ut_free(unit);
}

/// Of one increment, in addition to those that udunits2 knows.
constexpr std::array<std::string_view, 7> counted_aliases = {"pulse",  "pulses",  "step", "steps",
                                                             "sample", "samples", "LSB"};
constexpr std::array<std::string_view, 2> known_to_the_database = {"count", "counts"};

/// The unit database of udunits2, read once, with additional spellings of motion control.
ut_system* unit_database() {
  static ut_system* const database = [] {
    ut_set_error_message_handler(ut_ignore);
    ut_system* system = ut_read_xml(nullptr);
    if (!system)
      throw std::runtime_error("the unit database of udunits2 (package libudunits2-data) cannot be read");
    const auto alias = [system](const char* name, const char* meaning) {
      ut_unit* unit = ut_parse(system, meaning, UT_UTF8);
      ut_map_name_to_unit(name, UT_UTF8, unit);
      ut_free(unit);
    };
    make_hertz_count_cycles(system);
    alias("deg", "degree");
    alias("rev", "revolution");
    for (const std::string_view counted : counted_aliases) alias(std::string(counted).c_str(), "1");
    return system;
  }();
  return database;
}

/// Only temperatures have an offset.
bool read_offset(const ut_unit* parsed, Unit& unit) {
  ut_unit* const kelvin = ut_parse(unit_database(), "K", UT_UTF8);
  cv_converter* const to_kelvin = ut_get_converter(const_cast<ut_unit*>(parsed), kelvin);
  if (to_kelvin) {
    unit.offset = cv_convert_double(to_kelvin, 0.0);
    unit.is_point = true;
    cv_free(to_kelvin);
  }
  ut_free(kelvin);
  return unit.is_point;
}

std::optional<Unit> read_by_udunits(const std::string& text) {
  if (text.empty()) return Unit{};
  ut_unit* parsed = ut_parse(unit_database(), text.c_str(), UT_UTF8);
  if (!parsed) return {};
  Collector collector;
  const ut_status status = ut_accept_visitor(parsed, &Collector::visitor, &collector);
  const bool positive = collector.unit.scale > 0 && std::isfinite(collector.unit.scale);
  const bool good =
      status == UT_SUCCESS && positive && (!collector.has_offset || read_offset(parsed, collector.unit));
  ut_free(parsed);
  return good ? std::optional(collector.unit) : std::nullopt;
}

// ---- Roots, which udunits2 does not support
// ------------------------------------------------------------------------

/// unit = [scale] factor { ("*" | "/") factor },
/// factor = ("sqrt" "(" unit ")" | "(" unit ")" | name) [ "^" exponent ],
/// exponent = number | "(" integer ["/" integer] ")"
class RootReader {
 public:
  explicit RootReader(std::string_view text) : rest_(text) {}

  std::optional<Unit> read() {
    const auto unit = product();
    return rest_.empty() ? unit : std::nullopt;
  }

 private:
  bool take(std::string_view wanted) {
    if (!rest_.starts_with(wanted)) return false;
    rest_.remove_prefix(wanted.size());
    return true;
  }

  std::optional<Unit> product() {
    const bool has_scale =
        !rest_.empty() && rest_[0] >= '0' && rest_[0] <= '9';  // "0.7 m^(1/2)": the root applies only to m
    std::optional<Unit> result = has_scale ? scaled_factor() : factor();
    while (result) {
      const bool times = take("*") || take("·");
      if (!times && !take("/")) break;
      const auto next = factor();
      if (!next) return {};
      result = *result * (times ? *next : power(*next, -1));
    }
    return result;
  }

  std::optional<Unit> scaled_factor() {
    double scale = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), scale);
    if (error != std::errc() || !(scale > 0)) return {};
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    const Unit number{scale, {}};
    if (rest_.empty() || rest_[0] == '*' || rest_[0] == '/' || rest_[0] == ')') return number;
    take(" ");
    const auto unit = factor();
    return unit ? std::optional(number * *unit) : std::nullopt;
  }

  std::optional<Unit> factor() {
    std::optional<Unit> unit;
    const bool root = take("sqrt(");
    if (root || take("(")) {
      unit = product();
      if (!take(")")) return {};
      if (unit && root) unit = power(*unit, 0.5);
    } else {
      const std::string_view name = rest_.substr(0, rest_.find_first_of("*/^()"));
      rest_.remove_prefix(name.size());
      if (!name.empty()) unit = read_by_udunits(std::string(name));
    }
    if (!unit || !take("^")) return unit;
    const auto exponent = read_exponent();
    if (!exponent) return {};
    return power(*unit, *exponent);
  }

  std::optional<double> number() {
    double value = 0;
    const auto [end, error] =
        std::from_chars(rest_.data(), rest_.data() + rest_.size(), value, std::chars_format::fixed);
    if (error != std::errc() || std::abs(value) > 255) return {};
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return value;
  }

  std::optional<double> read_exponent() {
    if (!take("(")) return number();
    auto value = number();
    if (value && take("/")) {
      const auto divisor = number();
      if (!divisor || *divisor == 0) return {};
      *value /= *divisor;
    }
    if (!take(")")) return {};
    return value;
  }

  std::string_view rest_;
};

/// udunits2 reads "Hz^0.5" as Hz^0 times 0.5, so roots must be handled before calling it.
bool has_root(std::string_view text) {
  if (text.find("sqrt(") != text.npos) return true;
  for (size_t at = text.find('^'); at != text.npos; at = text.find('^', at + 1)) {
    const size_t end = text.find_first_not_of("+-0123456789", at + 1);
    if (end == text.npos) return false;
    if (text[end] == '(' || (text[end] == '.' && end + 1 < text.size() && std::isdigit(text[end + 1])))
      return true;
  }
  return false;
}

std::optional<Unit> read_unit(std::string_view text) {
  constexpr size_t longest_unit = 200;  // limits the work and the recursion for hostile input
  if (text.size() > longest_unit || text.find('\0') != text.npos) return {};
  const size_t first = text.find_first_not_of(' ');
  if (first == text.npos) return Unit{};
  text = text.substr(first, text.find_last_not_of(' ') + 1 - first);
  auto unit = has_root(text) ? RootReader(text).read() : read_by_udunits(std::string(text));
  if (unit)
    for (float& exponent : unit->exponents) exponent = exact_exponent(exponent);
  return unit;
}

}  // namespace

double Conversion::operator()(double number) const {
  constexpr double turn = 2 * std::numbers::pi;
  if (kind != Kind::turns) return number;
  if (cycles == 1) return number * turn;
  if (cycles == -1) return number / turn;
  return number * std::pow(turn, cycles);
}

Conversion conversion(const Unit& from, const Unit& to) {
  if (!from.same_dimension(to)) return {Conversion::Kind::impossible};
  const double cycles = double{from.cycles()} - double{to.cycles()};
  const double radians = double{to.radians()} - double{from.radians()};
  if (cycles == 0) {
    const bool may_be_turns = radians != 0 && (is_scaled_rate(from) || is_scaled_rate(to));
    return {may_be_turns ? Conversion::Kind::ambiguous : Conversion::Kind::none};
  }
  return {cycles == radians ? Conversion::Kind::turns : Conversion::Kind::ambiguous, cycles};
}

Unit operator*(const Unit& a, const Unit& b) {
  Unit product{a.scale * b.scale, {}};
  for (size_t i = 0; i < product.exponents.size(); ++i)
    product.exponents[i] = exact_exponent(double{a.exponents[i]} + double{b.exponents[i]});
  return product;
}

Unit power(const Unit& a, double exponent) {
  if (exponent == 1) return a;
  Unit result{any_power(a.scale, exponent), {}};
  for (size_t i = 0; i < result.exponents.size(); ++i)
    result.exponents[i] = exact_exponent(a.exponents[i] * exponent);
  return result;
}

bool is_counted(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (auto at = text.begin(); at != text.end();) {
    const auto first = std::find_if(at, text.end(), is_letter);
    at = std::find_if_not(first, text.end(), is_letter);
    const std::string_view word(first, at);
    const auto is_it = [word](std::string_view counted) { return word == counted; };
    if (std::ranges::any_of(counted_aliases, is_it) || std::ranges::any_of(known_to_the_database, is_it))
      return true;
  }
  return false;
}

std::optional<Unit> parse_unit(std::string_view text) {
  // udunits2 parses with global state, and a diagram uses the same few units thousands of times.
  static std::mutex mutex;
  static std::unordered_map<std::string, std::optional<Unit>> known;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = known.try_emplace(std::string(text));
  if (is_new) entry->second = read_unit(text);
  return entry->second;
}

}  // namespace loopwright
