/// The unit probably meant by a unit that does not exist.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// "did you mean "kg"?" for "Kg", "did you mean "N*m"?" for "Nm"; empty if no unit is similar.
std::string unit_hint(std::string_view text);

}  // namespace loopwright
