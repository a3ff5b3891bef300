/// What a signal measures, as far as its unit tells. Shapes of effects are offered where they make sense.
#pragma once
#include <optional>
#include <string_view>
#include "engine/unit/unit.h"

namespace loopwright::diagnosis {

enum class Quantity { position, velocity, force, temperature, heat, voltage, current, flow, other };

/// Position and velocity also of rotation, force also a torque; a level is a position, see Site::quantity.
Quantity quantity_of(const std::optional<Unit>& unit);
std::string_view name_of(Quantity quantity);

}  // namespace loopwright::diagnosis
