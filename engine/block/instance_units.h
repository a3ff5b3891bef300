/// The units of a block instance that its description does not give.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include "engine/json/problem.h"
#include "engine/unit/rescaling.h"

namespace loopwright {

/// `std::vector<UnitClaim> unit_claims() const` of a block: units that come from files, such as the unit of a
/// recorded column.
struct UnitClaim {
  std::string_view unit;       ///< as in the description: "$value"
  Unit is;                     ///< its scale is ignored: signals are in SI
  std::string_view parameter;  ///< the parameter that determines it, for messages
};

/// `FormulaUnit formula_unit(std::span<const Unit> of_wires) const` of a block whose first output is a
/// function of its inputs, which have no units of their own.
struct FormulaUnit {
  UnitFinding finding = UnitFinding::no_result;
  Unit unit;
  std::string_view parameter;  ///< the parameter that holds the function, for messages
  std::optional<Place> place{};  ///< of the function, if it is not that of the parameter
  std::string found;           ///< the function and the units of its arguments, if they are mixed
};

}  // namespace loopwright
