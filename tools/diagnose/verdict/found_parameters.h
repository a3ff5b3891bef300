/// The parameters of the effects that were found, with their intervals.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/conclude.h"

namespace loopwright::diagnosis {

/// Values and intervals of a member's parameters, in SI.
std::vector<DiagnosedParameter> parameters_of_member(const Conclusion& conclusion, size_t index,
                                                     const MachineUnits& units);
/// Amplitude and phase of A sin(x + phase) = sine sin x + cosine cos x, with intervals to first order; empty
/// of other members.
std::vector<DiagnosedParameter> wave_of_member(const Conclusion& conclusion, size_t index,
                                               const MachineUnits& units);

}  // namespace loopwright::diagnosis
