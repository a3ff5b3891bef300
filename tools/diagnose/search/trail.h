/// Lines that tell the user what the search tried and took.
#pragma once
#include <string>
#include <vector>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// "cogging + force_saturation of iron".
std::string names_of(const std::vector<Member>& members);

/// What happened to a set, its mean square and criterion, and its parameters.
std::string described(const char* what, const Estimate& estimate, double criterion);

/// What the linearization promises, best first.
std::string described(const std::vector<Proposal>& proposals);

}  // namespace loopwright::diagnosis
