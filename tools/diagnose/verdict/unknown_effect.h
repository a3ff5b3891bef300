/// An unnamed function as an effect, so that it can be written into a diagram.
#pragma once
#include <optional>
#include "tools/diagnose/search/candidate.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// A force that is a lookup block over the variables of the function, over the range of the records. Beyond
/// that range the values at its ends are held. Empty if no block can state it: a mass that varies with the
/// position would need the acceleration in the sum of forces that determines it, and a function of time needs
/// one clock for all records.
std::optional<Effect> effect_of_unknown(const Member& member, const RecordSizes& sizes);

/// What its blocks state, in words: "a lookup over position from 0 m to 500 mm; beyond them its ends are
/// held", "a step at 23.4 s"; empty for a tone.
std::string range_of_unknown(const Member& member, const RecordSizes& sizes, const MachineUnits& units);

/// By a clock, to a sample.
std::string told_instant(double time, double sample_time);

}  // namespace loopwright::diagnosis
