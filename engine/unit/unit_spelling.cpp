/// How a unit is written.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>
#include "engine/unit/base_symbols.h"
#include "engine/unit/unit.h"

namespace loopwright {
namespace {

using Exponents = decltype(Unit::exponents);

/// Usual spellings in motion control, where the search finds a shorter one (kg/s) or none.
constexpr std::string_view customary_spellings[] = {"N*s/m", "V*s^2/m", "ohm", "H", "F", "T", "A", "C"};

struct NamedUnit {
  std::string_view symbol;
  Exponents exponents;  // of m kg s A K mol cd
};

/// Components of the other spellings. J is not among them: N*m is as often a torque.
constexpr NamedUnit named_units[] = {
    {"N", {1, 1, -2, 0, 0, 0, 0}},
    {"V", {2, 1, -3, -1, 0, 0, 0}},
    {"W", {2, 1, -3, 0, 0, 0, 0}},
    {"Pa", {-1, 1, -2, 0, 0, 0, 0}},
};

struct Factor {
  std::string_view symbol;
  float exponent;
};

/// The reading cost of a spelling. Amperes cost extra: a gain of a voltage-driven motor is written V*s/m.
float reading_cost(const std::vector<Factor>& factors) {
  float cost = 0;
  for (const Factor& factor : factors)
    cost += std::abs(factor.exponent) * (factor.symbol == "A" ? 3.0f : 1.0f);
  return cost;
}

std::vector<Factor> base_factors(const Exponents& exponents) {
  constexpr int reading_order[] = {1, 0, 7, 2, 3, 4, 5, 6};  // kg*m/s, not m*kg/s
  std::vector<Factor> factors;
  if (exponents[Unit::cycle] != 0) factors.push_back({"Hz", exponents[Unit::cycle]});
  for (const int i : reading_order) {
    const float exponent = exponents[i] + (i == 2 ? exponents[Unit::cycle] : 0.0f);  // cycle = Hz*s
    if (exponent != 0) factors.push_back({base_symbols[i], exponent});
  }
  return factors;
}

std::vector<Factor> shortest_factors(const Exponents& exponents) {
  std::vector<Factor> best = base_factors(exponents);
  const bool is_kinematic = exponents[1] == 0 && exponents[3] == 0;  // m/s^2, never N/kg
  if (is_kinematic) return best;
  for (const NamedUnit& named : named_units) {
    for (const float times : {1.0f, -1.0f, 2.0f, -2.0f}) {
      Exponents remaining = exponents;
      for (size_t i = 0; i < remaining.size(); ++i) remaining[i] -= times * named.exponents[i];
      std::vector<Factor> factors = base_factors(remaining);
      factors.insert(factors.begin(), {named.symbol, times});
      if (reading_cost(factors) < reading_cost(best)) best = std::move(factors);
    }
  }
  return best;
}

std::string spelled(std::string_view symbol, float exponent) {
  if (exponent == 1) return std::string(symbol);
  const double twelfths = std::round(double{exponent} * 12);
  for (const int divisor : {1, 2, 3, 4, 6, 12}) {
    const double numerator = twelfths * divisor / 12;
    if (numerator != std::round(numerator)) continue;
    if (divisor == 1) return fmt::format("{}^{:.0f}", symbol, numerator);
    return fmt::format("{}^({:.0f}/{})", symbol, numerator, divisor);
  }
  return {};
}

/// "V*s^2/m", "J/(kg*K)", "1/s"
std::string spelled(const std::vector<Factor>& factors) {
  std::string above, below;
  int count_below = 0;
  for (const Factor& factor : factors) {
    std::string& side = factor.exponent > 0 ? above : below;
    if (!side.empty()) side += '*';
    side += spelled(factor.symbol, std::abs(factor.exponent));
    count_below += factor.exponent < 0;
  }
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + '/' + (count_below > 1 ? '(' + below + ')' : below);
}

/// The spelling of a unit whose scale is 1.
std::string spelled(const Exponents& exponents) {
  struct Customary {
    std::string_view spelling;
    Unit unit;
  };
  static const std::vector<Customary> customary = [] {
    std::vector<Customary> list;
    for (const std::string_view spelling : customary_spellings)
      list.push_back({spelling, parse_unit(spelling).value()});
    return list;
  }();
  for (const auto& [spelling, unit] : customary)
    if (unit.exponents == exponents) return std::string(spelling);
  return spelled(shortest_factors(exponents));
}

/// The SI prefix for a scale; nothing if there is none.
std::string_view prefix_of(double scale) {
  struct Prefix {
    double scale;
    std::string_view symbol;
  };
  constexpr Prefix prefixes[] = {{1e-12, "p"}, {1e-9, "n"}, {1e-6, "u"}, {1e-3, "m"},
                                 {1e3, "k"},   {1e6, "M"},  {1e9, "G"}};
  for (const Prefix& prefix : prefixes)
    if (std::abs(scale / prefix.scale - 1) < 4e-16) return prefix.symbol;
  return {};
}

/// Units that are not a product of a prefix and a spelling.
std::string_view name_of_scaled(const Unit& unit) {
  if (unit.scale == 1 && unit.offset == 0) return {};
  struct Named {
    std::string_view name;
    Unit unit;
  };
  static const std::vector<Named> list = [] {
    std::vector<Named> named;
    for (const std::string_view name :
         {"%", "deg", "rev", "rpm", "deg/s", "rev/s", "degC", "degF", "1/min", "1/h", "1/ms"})
      named.push_back({name, parse_unit(name).value()});
    return named;
  }();
  const auto found = std::ranges::find(list, unit, &Named::unit);
  return found == list.end() ? std::string_view() : found->name;
}

}  // namespace

std::string to_string(const Unit& unit) {
  if (const std::string_view name = name_of_scaled(unit); !name.empty()) return std::string(name);
  const std::string spelling = spelled(unit.exponents);
  if (unit.scale == 1) return spelling;
  if (spelling == "1") return fmt::format("{}", unit.scale);
  const bool takes_prefix = !spelling.starts_with("kg") && !spelling.starts_with('1') &&
                            spelling[std::min(spelling.find_first_of("*/^"), spelling.size() - 1)] != '^';
  const std::string_view prefix = takes_prefix ? prefix_of(unit.scale) : std::string_view();
  if (!prefix.empty()) return fmt::format("{}{}", prefix, spelling);
  return fmt::format("{} {}", unit.scale, spelling);
}

}  // namespace loopwright
