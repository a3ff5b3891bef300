/// Effects of which the record does not determine what matters.
#pragma once
#include <string>
#include "tools/diagnose/diagnosis.h"

namespace loopwright::diagnosis {

/// Why an effect that is needed is not believed: the intervals of all its sizes contain zero, as of a drift
/// that may go either way; or a time of it may be as long as any that is looked for, so that a straight line
/// in time has its name. Empty: it may be believed.
std::string why_not_determined(const DiagnosedEffect& effect);

}  // namespace loopwright::diagnosis
