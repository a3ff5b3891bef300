/// The answer about the record of an axis with the flaws of real ones.
#pragma once
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/flawed_axis.h"

namespace loopwright {

inline Diagnosis diagnosed(const FlawedMachine& machine) {
  const FlawedAxis axis(machine);
  return diagnose(axis.diagram(), {axis.experiment()});
}

}  // namespace loopwright
