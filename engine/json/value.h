/// A parameter value from a file, with its source location and unit. It is lightweight, so that block files
/// do not include a JSON parser.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/json/boxed.h"
#include "engine/json/problem.h"
#include "engine/unit/unit.h"

namespace loopwright {

struct Value {
  enum class Kind { null, boolean, number, text, list, object };
  struct Member;
  Kind kind = Kind::null;
  bool is_broken =
      false;  ///< a null in place of a value that could not be computed: the problem is already reported
  bool boolean = false;
  bool whole = false;        ///< the number was written without fraction or exponent
  bool is_computed = false;  ///< the unit comes from an expression: no conversion
  double number = 0;
  std::string text;  ///< of a text; for numbers from an expression, the expression
  Boxed<Unit> unit;  ///< set for numbers that come from parameters with units
  std::vector<Value> items;
  std::vector<Member> members;
  Place place;

  const Member* find(std::string_view name) const;
  /// Stands for a value whose problem is already reported.
  static Value broken(const Value& at);
};

struct Value::Member {
  std::string name;
  Place place;  ///< of the name
  Value value;
};

inline Value Value::broken(const Value& at) {
  Value value;
  value.is_broken = true;
  value.place = at.place;
  return value;
}

inline const Value::Member* Value::find(std::string_view name) const {
  for (const Member& member : members)
    if (member.name == name) return &member;
  return nullptr;
}

}  // namespace loopwright
