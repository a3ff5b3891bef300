/// The part of a system that connects its inputs to its outputs.
#pragma once
#include <limits>
#include "models/linear/poles.h"
#include "models/linear/state_space.h"

namespace loopwright {

/// The system without the states that no input reaches or that affect no output, by the sparsity pattern
/// alone. Blocks behind a disconnected wire are removed even if they are unstable, and no rank has to be
/// decided. The result is not always minimal.
StateSpace connected_part(const StateSpace& system);

/// The modes of a system, judged between its inputs and its outputs.
struct Modes {
  struct Outside {
    Pole pole;  ///< participation of all states of the system
    Stability stability;
  };
  Stability stability = Stability::stable;  ///< of the modes inside
  double outermost = 0;                     ///< largest |z|, or largest real part, of the modes inside
  /// Modes that do not decay and do not concern the inputs and outputs: a position behind a loop that
  /// controls the velocity, an integral that nothing reads. Those that grow are outside only if no wire
  /// connects them; those on the boundary also if they cancel, as a position of which only differences are
  /// read.
  std::vector<Outside> outside;
};

/// Delays are approximated.
Modes modes_between(const StateSpace& system);

}  // namespace loopwright
