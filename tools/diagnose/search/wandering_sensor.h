/// A sensor whose offset wanders, as one does that warms up or slips: its errors resemble a load that moves
/// by itself.
#pragma once
#include <optional>
#include <string>
#include "tools/diagnose/predict/wandering_offset.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

struct WanderingSensor {
  double size = 0;    ///< standard deviation of the offset, in the unit of the first measured port
  double time_s = 0;  ///< in which it falls to 37 %
  double gain = 0;    ///< by which -2 ln L is smaller than that of the estimate, with its noise fitted too
};

/// The most likely one, beside those members of the estimate that are no load of their own. Empty: the
/// records are maps of balances, or cannot be predicted without the load.
std::optional<WanderingSensor> wandering_sensor(Trials& trials, const Estimate& found);

/// "a position sensor whose offset wanders by 60 µm within 2 s explains the errors better: …".
std::string described(const Trials& trials, const WanderingSensor& sensor);

}  // namespace loopwright::diagnosis
