/// How sure an answer is where noise could explain anything.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

/// Findings: at which sites noise would explain the record, what the other opinion names, and which states
/// are not measured.
void tell_second_opinion(const SiteModel& model, const SecondOpinion& opinion, Diagnosis& result);

}  // namespace loopwright::diagnosis
