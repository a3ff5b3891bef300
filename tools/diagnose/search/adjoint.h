/// What the errors of the predictions say about a force of any course.
#pragma once
#include <vector>
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

/// For each sample, the derivative of the explained error with respect to the consumed (or equivalent) force
/// at that sample: one backward run through the filter instead of a forward run for every course.
std::vector<double> adjoint(const Trial& trial, const Fitted& fitted, Acts acts);

}  // namespace loopwright::diagnosis
