/// Perturbation by experiment: whether a pulse decays.
#pragma once
#include "engine/diagram/diagram.h"
#include "tools/stability/stability.h"

namespace loopwright {

/// Two runs of a diagram, one with a pulse added at `port` in the middle of its time; `position` is compared.
/// The pulse decays if over the last tenth of the remaining time the difference stays below a thousandth of
/// its peak or below `floor` (encoder counts never agree permanently), whichever is larger.
KickTest kick(const Diagram& diagram, const std::string& port, const std::string& position, double size,
              double duration, double floor, const RunOptions& options = {});

}  // namespace loopwright
