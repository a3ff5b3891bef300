/// The plots that pages of a diagnosis show, with roles and without.
#pragma once
#include "tools/diagnose/diagnosis.h"

namespace loopwright {

/// What all other effects leave, and the shape of this one through it.
report::Section terms_at_their_sites(const Diagnosis& diagnosis);
/// The error of each diagram of the staircase, as a curve that falls by steps.
report::Plot steps_of_the_error(const Diagnosis& diagnosis);
/// Correlation of the prediction errors, before and after.
report::Plot whiteness(const Diagnosis& diagnosis);
report::Section improved_diagram(const Diagnosis& diagnosis);

}  // namespace loopwright
