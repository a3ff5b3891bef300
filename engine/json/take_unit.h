/// Conversion of a number with a unit to the unit that is wanted.
#pragma once
#include "engine/json/reader.h"

namespace loopwright {

enum class UnitTaken {
  yes,   ///< the number is now in the wanted unit (SI)
  told,  ///< cycles and a plain number, or radians and a rate such as 1/min: a problem was reported
  no,    ///< another dimension: the caller reports it
};

/// Hertz are converted to radians per second by 2π, and back. While `name_changed_readings` is on, a warning
/// states both readings, as the two were once the same. The result of an expression is taken without
/// conversion, with a warning if it seems to be in the other unit; a result that is a rate such as 1/min is
/// refused where it can mean two numbers.
UnitTaken take_unit(Value& number, const Unit& wanted, const Reader& reader);

/// Whether conversions are named, in all threads; off at the start. `check` turns it on: a run need not say
/// each time that a number is read as it should be.
void name_changed_readings(bool on);

}  // namespace loopwright
