/// What a law with a memory remembers along a pass.
#pragma once
#include <array>
#include <vector>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// At the start, middle and end of each sample of a pass with columns, for a coefficient of one.
std::array<std::vector<double>, 3> remembered_along(const SiteModel& model, const SitePass& pass,
                                                    const SiteTerm& term);

}  // namespace loopwright::diagnosis
