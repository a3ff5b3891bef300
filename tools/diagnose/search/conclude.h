/// After the search: noise and parameters by maximum likelihood, material members, alternatives.
#pragma once
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/alternatives.h"
#include "tools/diagnose/search/second_look.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

struct Conclusion {
  Estimate estimate;
  std::vector<Weight> weights;                       ///< one per member
  std::vector<std::vector<Substitute>> substitutes;  ///< within reach, best first
  std::vector<OtherSet> other_sets;                  ///< within reach, best first
  std::vector<SmallEffect> too_small;                ///< beside the set, where it leaves no more than noise
  std::vector<double> inclusion;                     ///< probability that the effect is there, calibrated
  bool is_remainder_noise = true;                    ///< otherwise a slow force exceeds the noise
  double turn = 0;                                   ///< see Trials::turn
  double portmanteau = 0;  ///< n Σ ρ², 40 lags of the whitened errors; 40 when white
  double most_portmanteau = criteria::most_portmanteau;  ///< of errors that pass for white
  double counts_portmanteau = 0;   ///< what the counts of the sensor add to it, along this motion
  bool comes_in_bursts = false;    ///< large errors keep together in time, beyond what counts make of it
  bool is_negligible = false;      ///< the force that remains is not material, whatever its color
  std::vector<std::string> trail;  ///< what was removed, and why

  double portmanteau_beside_counts() const {
    return std::max(double(criteria::portmanteau_lags),
                    portmanteau - criteria::reach_of_counts * counts_portmanteau);
  }
  /// Whether the errors contain nothing more.
  bool is_white() const {
    return is_negligible || (is_remainder_noise && portmanteau_beside_counts() <= most_portmanteau);
  }
};

/// Joint maximum likelihood of parameters and noise; immaterial members are removed one by one. Sets that are
/// as good with fewer members, or better, take its place. None of them contains a candidate that was refused.
Conclusion conclude(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, Estimate found,
                    const std::vector<const Candidate*>& refused = {});

}  // namespace loopwright::diagnosis
