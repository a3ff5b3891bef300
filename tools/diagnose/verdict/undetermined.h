/// Effects of which the record does not determine what matters.
#pragma once
#include <string>
#include "tools/diagnose/diagnosis.h"

namespace loopwright::diagnosis {

/// Why an effect that is needed is not believed: the interval of its size, or of the amplitude of its wave,
/// contains zero, as of a drift that may go either way; or a time of it may be as long as any that is looked
/// for, and longer than the record, so that a straight line in time has its name. Of several sizes each may
/// be open while they are certain together: they are not asked. Empty: it may be believed.
std::string why_not_determined(const DiagnosedEffect& effect, double duration_s);

}  // namespace loopwright::diagnosis
