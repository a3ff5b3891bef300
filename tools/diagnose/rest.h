/// What an axis at rest tells about dry friction: with it the axis stays where it is, without it noise and
/// whatever force is left move it.
#pragma once
#include "tools/diagnose/hypothesis.h"

namespace loopwright::diagnosis {

/// How much the rows at rest speak against a set of members, as twice a log-likelihood; they are fitted to no
/// set.
///   nothing in the set holds:  n ln(m / 4) where the mean square m of the whitened errors at rest is more
///                              than four times that in motion: a force was there and moved nothing
///   something in it holds:     n/12 ln(1 + d / s) where the position x swerves, x(k) - 2 x(k-6) + x(k-12),
///                              by the square d + s (median of means over 36), s the sensor's (the same from
///                              sample to sample), and d is about what noise alone makes of a free axis:
///                              nothing held it
/// What gives at rest, in the set or in the user's own diagram, leaves both open: 0.
double against_at_rest(const Trials& trials, const std::vector<Member>& members,
                       const std::vector<Fitted>& fitted, const Noise& noise);

}  // namespace loopwright::diagnosis
