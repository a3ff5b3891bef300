/// What the name of an effect is worth beside a function without one.
#pragma once
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

bool has_function_without_name(const std::vector<Member>& members);
/// Those that are effects of the catalogue.
std::vector<Member> named_members(std::vector<Member> members);

/// [-2 ln L] What a set with such a function must gain over one that has names for all: a spline adapts
/// itself to small errors of an effect.
double worth_losing_names(const Trials& trials);

}  // namespace loopwright::diagnosis
