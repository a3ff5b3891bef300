/// The names of a recording in a MAT file.
#pragma once
#include <string>
#include <vector>

namespace loopwright::mat {

inline constexpr const char* names_variable = "loopwright_names";
inline constexpr const char* units_variable = "loopwright_units";
inline constexpr const char* facts_variable = "loopwright_facts";

/// One legal and unused MATLAB variable name for each name: [A-Za-z][A-Za-z0-9_]*, at most 63 characters, not
/// a keyword. Depends only on the names, so that reading finds the names that writing chose.
std::vector<std::string> legal_names(const std::vector<std::string>& names);

}  // namespace loopwright::mat
