/// Which settings of a diagram follow from a parameter through an expression.
#pragma once
#include <set>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// The paths of all numbers whose expression depends on one of these `--set` paths, except plain references
/// such as "=mass", whose number is that of the parameter. Equal names in different subdiagrams are not told
/// apart: the list may be longer than necessary, but is never shorter.
std::set<std::string> computed_settings(const Diagram& diagram, const std::vector<std::string>& paths);

}  // namespace loopwright
