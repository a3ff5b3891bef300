/// Numbers by the names of states and ports, as on the command line: "stage.position=2 mm".
#pragma once
#include <string>
#include <vector>
#include "engine/json/stated_number.h"

namespace loopwright {

struct NamedNumber {
  std::string name, text;  ///< text: as written
  StatedNumber number;
  std::string option;  ///< "--Q"
};

/// Reports texts that are not NAME=NUMBER UNIT, and names that occur twice.
std::vector<NamedNumber> named_numbers(const std::vector<std::string>& texts, std::string_view option,
                                       Problems& problems);

/// The number in SI, at least 0. Reports another dimension; a number without a unit is in SI. A signal
/// without a known unit takes only numbers without a unit.
double number_for(const NamedNumber& named, const std::optional<Unit>& signal, double exponent,
                  double seconds, Problems& problems);

}  // namespace loopwright
