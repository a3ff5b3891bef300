/// Once parameters and noise are fitted together, what else the records show. The search knew the noise only
/// roughly: under too much of it small effects hide.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// An effect that the records show with certainty, and that is too small to matter.
struct SmallEffect {
  const Candidate* candidate = nullptr;
  double gain = 0;  ///< of the criterion
  double force_rms = 0;
};

struct SecondLook {
  std::optional<Estimate> better;  ///< with a further member that is material
  std::vector<std::string> trail;
  std::vector<SmallEffect> small;  ///< best first; those that do nearly as well are other names of the first
};

/// `portmanteau`: of the estimate, without what the counts of the sensor add; `evidence`: of the estimate,
/// with the shapes of all candidates.
SecondLook look_again(Trials& trials, const Estimate& estimate, double portmanteau, const Evidence& evidence,
                      size_t catalogue);

}  // namespace loopwright::diagnosis
