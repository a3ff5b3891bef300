/// Limits of a controller in continuous time, and what its integral does there.
#pragma once
#include "blocks/math/sides.h"

namespace loopwright::blocks {

enum class AntiWindup { none, back_calculation, clamping };
constexpr auto names_of(AntiWindup) {
  return std::array<std::string_view, 3>{"none", "back_calculation", "clamping"};
}

/// Refuses limits without room between them, and back calculation without a speed.
inline void check_limits(const Checker& checker, double low, double high, AntiWindup anti_windup,
                         double tracking_gain) {
  if (!(low < high)) checker.error("low", "the limits leave no room for a command").expected = "low < high";
  if (anti_windup != AntiWindup::back_calculation || tracking_gain > 0.0) return;
  auto& p = checker.error("tracking_gain", "back calculation needs a speed");
  p.expected = "a number above 0, in 1/s";
  p.hint = "Ki/Kp is a usual choice";
}

/// u = v within [low, high], and the rate of the integral I' = Ki e with its protection:
///   back_calculation   I' = Ki e + tracking_gain (u - v)
///   clamping           I' = 0 where v is outside and Ki e would drive it further out
///
/// A switch between I' = Ki e and 0 would chatter where Ki e drives v to a limit and the rest of v drives it
/// back. Ki e therefore fades out over a hundredth of the greatest limit beyond it; the command is at its
/// limit all the while.
template <class Real> struct CommandLimits {
  Real low = -infinity, high = infinity, tracking_gain = 0.0, per_fading = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;

  static CommandLimits of(const Real& low, const Real& high, AntiWindup anti_windup,
                          const Real& tracking_gain) {
    const auto finite = [](const Real& limit) {
      return select(is_finite(limit), absolute(limit), Real(0.0));
    };
    const Real greatest = maximum(finite(low), finite(high));
    return {low, high, tracking_gain, select(greatest > 0.0, 100.0 / greatest, Real(0.0)), anti_windup};
  }
  LW_INLINE Real limited(const Real& v) const { return minimum(maximum(v, low), high); }
  /// `drive`: Ki e.
  LW_INLINE Real integral_rate(const Real& v, const Real& drive) const {
    const Real excess = v - limited(v);
    if (anti_windup == AntiWindup::back_calculation) return drive - tracking_gain * excess;
    if (anti_windup == AntiWindup::none) return drive;
    const Real faded = drive * maximum(Real(0.0), 1.0 - per_fading * absolute(excess));
    return select(excess * drive > 0.0, faded, drive);
  }
  // Crossing functions, finite also without a limit.
  LW_INLINE Real above_low(const Real& v) const { return minimum(Real(v - low), Real(1e300)); }
  LW_INLINE Real above_high(const Real& v) const { return maximum(Real(v - high), Real(-1e300)); }
};

}  // namespace loopwright::blocks
