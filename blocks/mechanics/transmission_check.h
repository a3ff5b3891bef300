/// The conditions on the losses of a transmission, shared by gear, screw and belt.
#pragma once
#include "engine/block.h"

namespace loopwright::blocks {

inline void check_losses(const Checker& checker, double efficiency, double backwards, double transition) {
  if (!(efficiency > 0 && efficiency <= 1)) {
    auto& p = checker.error("efficiency", "the efficiency is out of range");
    p.expected = "above 0, at most 1", p.found = std::to_string(efficiency);
  }
  if ((efficiency < 1 || (backwards > 0 && backwards < 1)) && !(transition > 0)) {
    auto& p =
        checker.error("transition", "losses change with the direction of motion and need a width there");
    p.expected = "a velocity of the output above 0, small beside those of the motion";
  }
}

}  // namespace loopwright::blocks
