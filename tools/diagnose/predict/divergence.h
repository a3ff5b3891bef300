/// Where a diagram that cannot follow a record stops being finite.
#pragma once
#include <string>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// Of the last pass, which has failed: the row, the states there, and the block that gives no number.
std::string told_divergence(SiteFilter& filter);

}  // namespace loopwright::diagnosis
