/// Sets whose parts undo each other: each explains what another one brings, and none of them is there.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Why such a set is not believed: a part of it makes much more force than is missing. Empty: none does. A
/// gain may, with the mass and the damping that it changes by one factor.
std::string why_effects_cancel(const Diagnosis& diagnosis);

/// Why a law is not believed: two of its levels, in the unit of the site, are much larger than what it does.
/// Friction that falls over more than the speeds of the record is another law. Empty: they are not.
std::string why_levels_cancel(const DiagnosedEffect& effect);

/// Why laws of the input are not believed: they leave too little of it, beside the factor that a gain states.
/// Empty: they leave enough.
std::string why_input_is_taken_away(const Trials& trials, const Estimate& estimate);

}  // namespace loopwright::diagnosis
