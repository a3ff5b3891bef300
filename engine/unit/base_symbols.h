/// The base units in the order of Unit::exponents.
#pragma once
#include <array>
#include <string_view>

namespace loopwright {

inline constexpr std::string_view cycle_symbol = "cycle of Hz";  // not a name that can occur in a text
inline constexpr std::array<std::string_view, 9> base_symbols = {"m",   "kg", "s",   "A",         "K",
                                                                 "mol", "cd", "rad", cycle_symbol};

}  // namespace loopwright
