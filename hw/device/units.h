/// Units of the numbers in a device file.
#pragma once
#include <string>
#include <string_view>
#include "engine/block/parameters.h"
#include "engine/json/reader.h"

namespace loopwright::hw {

/// What the symbols in the units of described parameters mean: "$unit" is the unit of a channel's value, and
/// "/$raw" divides by the unit of its raw number.
struct ChannelUnits {
  std::string unit, per_raw;
  /// "$unit/$raw" with {"A", "/V"} is "A/V".
  std::string in_place_of(std::string_view described) const;
};

/// Converts a number that has a unit to `wanted` (SI). A unit of another dimension is a problem, which names
/// both. A number without a unit is in SI already.
void take_number(Value& number, std::string_view name, const std::string& wanted, const Reader& reader);

/// As read_fields, with the unit of every number checked.
template <class T>
void read_with_units(T& to, Value object, const std::string& block, Problems& problems,
                     const ChannelUnits& units = {}) {
  for_each<T, is_parameter>([&](auto, const auto& p) {
    for (Value::Member& member : object.members)
      if (member.name == p.name)
        take_number(member.value, p.name, units.in_place_of(p.unit), {problems, block});
  });
  read_fields(to, object, block, problems);
}

}  // namespace loopwright::hw
