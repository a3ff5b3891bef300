/// A sensor whose offset wanders: o[k+1] = memory o[k] + step w[k] is added to the first measured port.
#pragma once
#include "tools/diagnose/predict/noise.h"

namespace loopwright::diagnosis {

struct WanderingOffset {
  double size = 0;            ///< standard deviation, in the unit of the port
  double memory_samples = 0;  ///< in which it falls to 37 %
};

/// The axis with the offset as its last state. It must have no loads of its own.
LinearAxis with_offset(const LinearAxis& axis, const WanderingOffset& offset);

/// Gains of the axis alone, as gains of the axis with the offset: they do not correct it.
Gains without_correction_of_offset(const Gains& gains);

}  // namespace loopwright::diagnosis
