/// Exact times from parameters: a source that switches every 3 ms switches at sample 3 k of a millisecond
/// grid for every k, although 0.003 k is rounded.
#pragma once
#include <span>
#include "models/real/fraction.h"
#include "models/real/real.h"

namespace loopwright {

/// The fraction intended by a time [s] >= 0, if any: a simple fraction given by twelve digits, or one that
/// differs from it only by rounding. A time without such a fraction, such as 1/π, is left unchanged.
[[maybe_unused]] static std::optional<Fraction> meant_fraction(double time) {
  constexpr int64_t simple = 100'000;
  constexpr double rounding = 0x1p-50;
  const auto near = to_fraction(time);
  return near && near->denominator <= simple ? near : to_fraction(time, rounding);
}

/// Converts times [s] to integer counts of one unit and returns the number of units per second. A time
/// computed from such counts, (a + k b) / units_per_second, is then the double nearest to its exact value, as
/// are the times of samples (TickClock): the two are equal if and only if the exact times are. Lanes in which
/// the times have no common unit keep seconds, and the result is 1.
template <class Real> Real to_counts(std::span<Real* const> times) {
  constexpr double finest = 1e12;  // units per second: counts stay integers for more than two hours
  Real units = 1.0;
  for (int l = 0; l < lanes_of<Real>; ++l) {
    int64_t common = 1;
    bool is_exact = true;
    for (const Real* time : times) {
      const auto fraction = meant_fraction(__builtin_fabs(lane(*time, l)));
      if (!fraction) {
        is_exact = false;
        break;
      }
      const double denominator =
          double(common) * double(fraction->denominator / std::gcd(common, fraction->denominator));
      if (!(is_exact = denominator <= finest)) break;
      common = int64_t(denominator);
    }
    if (!is_exact) continue;
    set_lane(units, l, double(common));
    for (Real* time : times) {
      const double seconds = lane(*time, l);
      const Fraction fraction = *meant_fraction(__builtin_fabs(seconds));
      const double count = double(fraction.numerator) * double(common / fraction.denominator);
      set_lane(*time, l, seconds < 0 ? -count : count);
    }
  }
  return units;
}

/// The double nearest to the intended exact time: 0.0003, not 3 * 0.0001.
template <class Real> Real exact_time(const Real& time) {
  Real count = time;
  Real* const all[] = {&count};
  const Real units = to_counts<Real>(all);
  return count / units;
}

/// Consecutive periods from a start time on.
template <class Real> struct Periods {
  Real start = 0.0, period = 1.0, units = 1.0;  ///< start and period in units; units per second

  /// The time [s] `units_later` units after the start of period k.
  LW_INLINE Real time(const Real& k, const Real& units_later = 0.0) const {
    return ((start + k * period) + units_later) / units;
  }
  /// The largest integer k whose period has begun at this time [s].
  LW_INLINE Real at(const Real& now) const {
    const Real k = floor_of((now * units - start) / period);
    return select(time(k) > now, k - 1.0, select(time(k + 1.0) <= now, k + 1.0, k));
  }
};

}  // namespace loopwright
