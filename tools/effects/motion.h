/// A separating experiment as a motion that can be run on the machine or in simulation.
#pragma once
#include "tools/effects/effect.h"

namespace loopwright {

struct Motion {
  double sample_time = 0;           ///< [s]
  std::vector<double> position;     ///< [position] reference at every sample
  std::vector<double> added_force;  ///< [force] to be added to the command; zero without a chirp
  double added_mass = 0;            ///< [force s²/position] additional load
};

/// Strokes back and forth over the stated part of the stroke, centered on that of the record, at every speed,
/// with sinusoidal accelerations; then a chirp over all of it, if there is one.
Motion motion_of(const SeparatingExperiment& experiment, const RecordSizes& sizes);

}  // namespace loopwright
