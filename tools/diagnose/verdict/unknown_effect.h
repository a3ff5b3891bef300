/// An unnamed function as an effect, so that it can be written into a diagram.
#pragma once
#include <optional>
#include "tools/diagnose/search/candidate.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// A force that is a lookup block over the variables of the function, over the range of the records. Beyond
/// that range the values at its ends are held. Empty if no block can state it: a mass that varies with the
/// position would need the acceleration in the sum of forces that determines it.
std::optional<Effect> effect_of_unknown(const Member& member, const RecordSizes& sizes);

/// Where the lookup ends, and what it does there, in words: "held beyond 0 … 0.5 m"; empty for a tone.
std::string range_of_unknown(const Member& member, const RecordSizes& sizes, const MachineUnits& units);

}  // namespace loopwright::diagnosis
