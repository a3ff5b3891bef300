/// What makes a trained model doubtful, in sentences.
#pragma once
#include "tools/gp/train.h"

namespace loopwright {

/// What the samples cannot tell, whatever was made of them: no reason for doubt, but good to know.
std::vector<std::string> limits_of(const TrainedModel& trained);

std::vector<std::string> warnings_of(const Training& training, const TrainedModel& trained);

}  // namespace loopwright
