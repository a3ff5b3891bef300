/// Sensors whose errors a diagnosis without roles did not look for.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// An offset of a sensor bends what is found beside it. One beside a single change was asked for.
void tell_sensors_not_looked_at(SiteModel& model, const SiteHypothesis& found, Diagnosis& result);

}  // namespace loopwright::diagnosis
