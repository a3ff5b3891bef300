/// Loads that effects hang on the axis, as states of the predictor: an error of the estimated motion moves
/// them too, and they push back. Coarse counts or a loud sensor would otherwise shake a load along its path
/// that no measurement ever corrects.
#pragma once
#include "tools/diagnose/predict/axis_model.h"
#include "tools/effects/linear_effect.h"

namespace loopwright::diagnosis {

/// The axis with one more load: its states follow those that there are, as deviations from the motion that
/// the load has along the path on which the effect ran. Unchanged if position or velocity is no state of the
/// axis. `load`: all its parameters as fitted. Its force within a sample enters by its mean.
LinearAxis with_load(LinearAxis axis, const SampleMap& load);

}  // namespace loopwright::diagnosis
