/// Members that do not justify their cost.
#pragma once
#include <optional>
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

/// The estimate without them, fitted with a given noise. One member stays.
Estimate pruned(Trials& trials, Estimate estimate, const Noise& noise, size_t catalogue);

/// The estimate without the member that the record asks for least, if the criterion prefers that: with the
/// noise of the search it had asked for more.
std::optional<Estimate> without_needless(Trials& trials, const Estimate& estimate,
                                         const std::vector<Weight>& weights);

}  // namespace loopwright::diagnosis
