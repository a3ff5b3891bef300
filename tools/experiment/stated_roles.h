/// Experiments that name the roles of their signals, or do not.
#pragma once
#include <string>
#include <vector>

namespace loopwright {

/// Whether these experiments name roles. Throws InputError if only some do, or if a record is there twice.
bool have_roles(const std::vector<std::string>& experiments);

}  // namespace loopwright
