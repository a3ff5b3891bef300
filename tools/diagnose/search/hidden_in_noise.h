/// Noise of the force that is none: most of it is a function of the motion.
#pragma once
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// The likelihood takes for noise whatever the members leave, and every further member is weighed by that
/// noise. Beside coarse counts, which show a force only by its mean over many rows, it can grow until nothing
/// is seen in it, with white errors. A function without a name that belongs there takes most of it away, if
/// it is weighed with noise of its own. The best such function beside the members; empty: it is noise.
std::optional<Estimate> hidden_in_noise(Trials& trials, const Estimate& found,
                                        const std::vector<Candidate>& unknown, size_t catalogue,
                                        std::vector<std::string>& trail);

}  // namespace loopwright::diagnosis
