/// Conversion of a number with a unit to the unit that is wanted.
#pragma once
#include "engine/json/reader.h"

namespace loopwright {

enum class UnitTaken {
  yes,   ///< the number is now in the wanted unit (SI)
  told,  ///< cycles and a plain number: a problem was reported
  no,    ///< another dimension: the caller reports it
};

/// Hertz are converted to radians per second by 2π, and back. A warning states both readings, as the two were
/// once the same. The result of an expression is taken without conversion, with a warning if it seems to be
/// in the other unit.
UnitTaken take_unit(Value& number, const Unit& wanted, const Reader& reader);

/// Whether `take_unit` would leave the number unchanged; a fast check that covers most numbers.
inline bool is_taken_as_it_is(const Value& number, const Unit& wanted) {
  return !number.unit || number.unit->cycles() == wanted.cycles();
}

}  // namespace loopwright
