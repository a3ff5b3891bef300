/// Reasons to doubt a trained model, in sentences.
#pragma once
#include "tools/gp/train.h"

namespace loopwright {

/// What the samples cannot determine, whatever the model: no reason for doubt, but useful information.
std::vector<std::string> limits_of(const TrainedModel& trained);

std::vector<std::string> warnings_of(const Training& training, const TrainedModel& trained);

}  // namespace loopwright
