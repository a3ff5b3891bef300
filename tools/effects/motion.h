/// A separating experiment as a motion that can be run: on the machine, or in simulation.
#pragma once
#include "tools/effects/effect.h"

namespace loopwright {

struct Motion {
  double sample_time = 0;           ///< [s]
  std::vector<double> position;     ///< [position] reference at every sample
  std::vector<double> added_force;  ///< [force] to be added to the command; zeros without a chirp
  double added_mass = 0;            ///< [force s²/position] to be carried
};

/// Strokes to and fro over the stated part of the stroke, centred on that of the record, at every speed, with
/// accelerations shaped as a sine; then a chirp over all of it, if there is one.
Motion motion_of(const SeparatingExperiment& experiment, const RecordSizes& sizes);

}  // namespace loopwright
