#include "tools/diagnose/predict/quantity.h"
#include <array>
#include <utility>

namespace loopwright::diagnosis {
namespace {

bool is_angle(const Unit& unit, double radians) { return unit.radians() == float(radians); }

}  // namespace

Quantity quantity_of(const std::optional<Unit>& unit) {
  if (!unit) return Quantity::other;
  static const std::array<std::pair<Unit, Quantity>, 10> known{{
      {*parse_unit("m"), Quantity::position},
      {*parse_unit("m/s"), Quantity::velocity},
      {*parse_unit("N"), Quantity::force},
      {*parse_unit("N*m"), Quantity::force},
      {*parse_unit("K"), Quantity::temperature},
      {*parse_unit("W"), Quantity::heat},
      {*parse_unit("V"), Quantity::voltage},
      {*parse_unit("A"), Quantity::current},
      {*parse_unit("m^3/s"), Quantity::flow},
      {*parse_unit("kg/s"), Quantity::flow},
  }};
  for (const auto& [of_quantity, quantity] : known)
    if (unit->same_dimension(of_quantity) && unit->cycles() == 0) return quantity;
  static const Unit angle = *parse_unit("rad"), speed = *parse_unit("rad/s");
  if (unit->same_dimension(angle) && is_angle(*unit, 1)) return Quantity::position;
  if (unit->same_dimension(speed) && (is_angle(*unit, 1) || unit->cycles() == 1)) return Quantity::velocity;
  return Quantity::other;
}

std::string_view name_of(Quantity quantity) {
  constexpr std::string_view names[] = {"position", "velocity", "force", "temperature", "heat",
                                        "voltage",  "current",  "flow",  "other"};
  return names[size_t(quantity)];
}

}  // namespace loopwright::diagnosis
