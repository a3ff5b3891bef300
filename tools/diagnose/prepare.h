/// Records ready for the search: noise, rows that count, the motion.
#pragma once
#include "tools/diagnose/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Reads the experiments, works out which rows count, and estimates the noise with a random walk standing in
/// for every missing force. `motion` is what that first prediction saw: unbiased whatever is missing.
Trials prepare(const std::string& diagram, const std::vector<std::string>& experiments,
               const LoadOptions& options, Motion& motion);

}  // namespace loopwright::diagnosis
