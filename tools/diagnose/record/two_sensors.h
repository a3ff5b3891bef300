/// A position and a velocity of one axis that contradict each other.
#pragma once
#include <optional>
#include "tools/diagnose/record/axis_record.h"

namespace loopwright::diagnosis {

/// How many times the rate of the measured position the measured velocity is, by least squares over stretches
/// of a twentieth of a second: v = b dx/dt. Nothing if one of the two was not measured, or if noise and
/// counts let them agree.
std::optional<double> velocity_over_rate(const AxisRecord& record);

}  // namespace loopwright::diagnosis
