/// Members that do not justify their cost.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// The estimate without them, fitted with a given noise. One member stays.
Estimate pruned(Trials& trials, Estimate estimate, const Noise& noise, size_t catalogue);

}  // namespace loopwright::diagnosis
