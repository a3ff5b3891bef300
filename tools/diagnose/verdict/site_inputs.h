/// What the experiment states about its inputs, held against the record.
#pragma once
#include <vector>
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// What an input does between its rows is a statement of the experiment. Held in the place of a curve, or the
/// reverse, it acts half a sample later; on lines it is weaker than a smooth one. Terms may stand for that.
/// Whether a statement is questioned.
bool question_inputs(SiteFitter& fitter, const SiteHypothesis& found, std::vector<RecordFinding>& findings);

}  // namespace loopwright::diagnosis
