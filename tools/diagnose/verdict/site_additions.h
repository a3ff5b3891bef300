/// What a diagnosis without roles found, as it can be added to the diagram.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Terms as blocks, and the parameters that moved. `leave_out` are the terms that are not added.
Additions site_additions(const SiteModel& model, const SiteHypothesis& found,
                         const std::vector<bool>& leave_out);

}  // namespace loopwright::diagnosis
