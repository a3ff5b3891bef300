/// What can only be learnt on a machine with the vendor's library, or with a card.
#pragma once
#include <functional>
#include "hw/quanser/quanser.h"

namespace loopwright::hw::quanser {

struct ProbeAnswer {
  std::string question, answer;
  bool is_good = true;
};

/// Asks the library and the card. With `may_touch` the card is set up too: encoder counts are preset, 0 V put
/// out, the watchdog is let to expire. Without it nothing but opening and closing happens.
/// A card in use is opened only where `may_take_over`, told who has it, agrees.
std::vector<ProbeAnswer> probe(const Settings& settings, bool may_touch,
                               const std::function<bool(const std::string&)>& may_take_over);

}  // namespace loopwright::hw::quanser
