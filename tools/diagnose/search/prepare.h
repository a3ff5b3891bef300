/// Prepares records for the search: noise, rows that count, the motion.
#pragma once
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Reads the experiments, determines which rows count, and estimates the noise with a random walk in place of
/// every missing force. `motion` is the estimate of that first prediction: unbiased whatever is missing.
/// `correction`: of the inputs, see AxisModel.
Trials prepare(const std::string& diagram, const std::vector<std::string>& experiments,
               const LoadOptions& options, Motion& motion, const InputCorrection& correction = {});

}  // namespace loopwright::diagnosis
