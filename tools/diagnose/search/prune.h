/// Members that do not justify their cost.
#pragma once
#include <optional>
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

/// The estimate without them, fitted with a given noise. One member stays.
Estimate pruned(Trials& trials, Estimate estimate, const Noise& noise, size_t catalogue);

/// The estimate without an input that is late, if the distance of its delay from zero, in standard
/// deviations, is not worth its price: Weight::loss. Beside coarse counts the likelihood alone may prefer a
/// delay that is none.
std::optional<Estimate> without_uncertain_delay(Trials& trials, const Estimate& estimate,
                                                const std::vector<Weight>& weights);

}  // namespace loopwright::diagnosis
