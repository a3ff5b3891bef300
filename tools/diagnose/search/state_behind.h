/// Variables that are but another scale of a state.
#pragma once
#include <vector>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// For each variable the state of which it is a rising or falling function along the pass, as the current of
/// a diode is of its voltage; itself where there is none.
std::vector<int> states_behind(const SiteModel& model, const SitePass& pass);

}  // namespace loopwright::diagnosis
