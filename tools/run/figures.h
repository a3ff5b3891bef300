/// Figures of merit of a run: how well signals follow their references, and how long limits hold.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"
#include "engine/record/recording.h"

namespace loopwright {

/// A logged signal and the logged signal that it is to follow.
struct FollowedSignal {
  std::string signal, reference;  ///< names of columns
  std::string unit;               ///< SI; empty: not known
  double band = 0;                ///< SI; 0: 2 % of the reference's last move
  bool is_guess = false;          ///< not from "figures", but from a controller or a difference
};

/// What "figures" of the diagram asks for, or else the pairs that controllers and differences of two logged
/// signals suggest. Names that are not logged, and bands in a wrong unit, are problems.
std::vector<FollowedSignal> followed_signals(const Diagram& diagram, const Plan& plan, Problems& problems);

/// What controllers and differences of two logged signals suggest.
std::vector<FollowedSignal> guessed_signals(const Plan& plan);

/// How a signal follows its reference; e = reference - signal.
struct TrackingFigures {
  FollowedSignal followed;
  double rms = 0;       ///< of e over the time of the run
  double greatest = 0;  ///< |e|
  double at = 0;        ///< s, of the greatest
  double last = 0;      ///< e at the end

  /// What the signal is to do once the reference rests.
  struct Move {
    enum class Kind {
      stop,   ///< the reference stops after it moved through several rows
      jump,   ///< within a row: overshoot counts from the jump
      start,  ///< the reference is constant, and the signal moves to it from its own first value
      stay    ///< the reference is constant, and the signal begins there, to stay within a stated band
    };
    Kind kind = Kind::stop;
    double end = 0;                  ///< s, when the reference stops
    double size = 0;                 ///< signed; 0 for `stay`
    double band = 0;                 ///< around the target
    double overshoot = 0;            ///< beyond the target in the direction of the move; at least 0
    std::optional<double> settling;  ///< s from `end` until |e| stays within the band; nothing: it has not
                                     ///< been there for a tenth of the time after `end`, and two rows
    double ripple = 0;  ///< half of the range of e over the last tenth of the time after the move
  };
  /// Nothing: the reference does not come to rest, or it is constant, and there is no move and no band.
  std::optional<Move> move;
  bool is_constant = false;  ///< the reference, throughout
  /// |e| grows throughout the time after the move, or the run: oscillations that build up, or a divergence.
  bool grows = false;
};

/// Throws nothing; a recording of fewer than two rows has no figures.
std::optional<TrackingFigures> tracking_figures(const FollowedSignal& followed, const Recording& recording);

/// Whether the swing of a signal grows by half or more in each of the last three quarters of the run.
bool swings_up(const std::vector<double>& values);

}  // namespace loopwright
