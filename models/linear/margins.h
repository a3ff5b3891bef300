/// Stability margins of feedback loops.
#pragma once
#include <limits>
#include "models/linear/structure.h"

namespace loopwright {

/// Margins of a loop with gain L and negative feedback, 1/(1 + L). A margin that no frequency limits is
/// infinite (0 for the lower gain margin) with frequency 0. Frequencies are in rad/s.
struct Margins {
  /// Of the closed loop; if it is unstable, the margins are the distance from stability.
  Stability stability = Stability::unstable;
  double gain = std::numeric_limits<double>::infinity(),
         gain_frequency = 0;                        ///< smallest factor > 1 that changes stability
  double lower_gain = 0, lower_gain_frequency = 0;  ///< largest factor < 1 that changes stability
  double phase = std::numeric_limits<double>::infinity(), phase_frequency = 0;  ///< rad
  double delay = std::numeric_limits<double>::infinity(),
         delay_frequency = 0;           ///< s of additional delay that change stability
  double Ms = 1, Ms_frequency = 0;      ///< largest |1/(1 + L)|: 1/Ms is the distance of L from -1
  double largest_pole = 0;              ///< |z| of the closed loop, or the largest real part
  std::vector<Modes::Outside> outside;  ///< modes that do not decay, and that are not judged above

  bool is_stable() const { return stability == Stability::stable; }
};

/// Computed from the response at about a thousand frequencies; crossings and the peak are refined. `lifted`
/// as in FrequencyResponse.
Margins margins(const StateSpace& loop_gain, int lifted = 1);

/// The loop closed around a gain L with negative feedback, from its input to its output: L/(1 + L). Delays
/// are approximated.
StateSpace closed_loop(const StateSpace& loop_gain);

}  // namespace loopwright
