/// Facts that can only be found out on a machine with the vendor's library, or with a card.
#pragma once
#include <functional>
#include "hw/quanser/quanser.h"

namespace loopwright::hw::quanser {

struct ProbeAnswer {
  std::string question, answer;
  bool is_good = true;
};

/// Queries the library and the card. With `may_touch` the card is also set up: encoder counts are preset, 0 V
/// is output, and the watchdog is allowed to expire. Without it the card is only opened and closed. A card in
/// use is opened only if `may_take_over`, given its present user, agrees.
std::vector<ProbeAnswer> probe(const Settings& settings, bool may_touch,
                               const std::function<bool(const std::string&)>& may_take_over);

}  // namespace loopwright::hw::quanser
