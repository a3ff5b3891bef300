/// Time as integer ticks: every sample time is a multiple of one base period, which is an exact fraction of a
/// second.
#pragma once
#include "models/real/fraction.h"

namespace loopwright {

/// The base period of a plan. Time is tick · base, computed by one multiplication and one division, never
/// summed: it is the double nearest to the exact time, as long as tick · numerator is below 2⁵³.
struct TickClock {
  Fraction base{1, 1000};
  double time(int64_t tick) const { return double(tick * base.numerator) / double(base.denominator); }
};

}  // namespace loopwright
