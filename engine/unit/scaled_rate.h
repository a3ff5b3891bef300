/// Rates per minute, hour or millisecond, which may count revolutions.
#pragma once
#include "engine/unit/unit.h"

namespace loopwright {

/// A reciprocal of time, or of its square, whose scale is not 1: 1/min, 1/ms, 1/(min*s). Where radians are
/// wanted it can mean two numbers, as a plain 1/s does where cycles are wanted.
bool is_scaled_rate(const Unit& unit);

/// The unit that a number keeps after its conversion to SI: `in_si()`, but a scaled rate keeps its scale, by
/// which `conversion` recognizes it.
Unit kept_in_si(const Unit& unit);

}  // namespace loopwright
