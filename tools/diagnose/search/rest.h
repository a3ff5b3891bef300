/// What an axis at rest shows about dry friction: with it the axis keeps its position, without it noise and
/// any remaining force move the axis.
#pragma once
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

/// How strongly the rows at rest speak against a set of members, as twice a log-likelihood. They are not
/// fitted to any set.
///   nothing in the set holds:  n ln(m / 8) where the mean square m of the whitened errors at rest is more
///                              than eight times that in motion: a force was there and moved nothing
///   something in it holds:     n/12 ln(1 + d / s) where the second difference over twice 6 ms of
///                              the position has the mean square d + s (median of means over 36 ms), s is the
///                              sensor's (the same from sample to sample), and d is about what noise alone
///                              causes on a free axis: nothing held it. Where it moves on in one direction
///                              it slides, and says nothing
/// If the set yields at rest, or the user's own diagram has dry friction, both are undecided: 0. Of a rest,
/// what happens after `least_rest_s` counts: at first an axis that turns slowly seems to rest.
double against_at_rest(const Trials& trials, const std::vector<Member>& members,
                       const std::vector<Fitted>& fitted, const Noise& noise, double least_rest_s = 0);

}  // namespace loopwright::diagnosis
