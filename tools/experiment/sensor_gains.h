/// Sensors that a diagram states as Gains: counts, volts or degrees in place of the quantity itself.
#pragma once
#include "engine/plan/plan.h"
#include "tools/experiment/experiment.h"

namespace loopwright {

/// Columns measured behind Gains become columns of the ports that the roles "position" and "velocity" name:
/// divided by the gains, resolutions too. A role that itself names the output of such a sensor, in another
/// dimension than what the sensor reads, becomes the port that the sensor reads.
Experiment without_sensor_gains(const Plan& plan, Experiment experiment);

}  // namespace loopwright
