/// A number with a unit comes to a place that wants another one.
#pragma once
#include "engine/json/reader.h"

namespace loopwright {

enum class UnitTaken {
  yes,   ///< the number is now in the wanted unit (SI)
  told,  ///< cycles meet a plain number: a problem
  no,    ///< another dimension: the caller says so
};

/// Hertz become radians per second by 2π, and back; a warning names both readings, as the two were once the
/// same. A result of an expression is taken as it is, with a warning where it seems to be in the other unit.
UnitTaken take_unit(Value& number, const Unit& wanted, const Reader& reader);

/// Whether `take_unit` would leave the number as it is; most numbers can be told so without more.
inline bool is_taken_as_it_is(const Value& number, const Unit& wanted) {
  return !number.unit || number.unit->cycles() == wanted.cycles();
}

}  // namespace loopwright
