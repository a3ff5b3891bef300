/// A card that another program has open: which program that may be.
#pragma once
#include <string>
#include <vector>
#include "hw/quanser/library.h"
#include "hw/quanser/quanser.h"

namespace loopwright::hw::quanser {

/// "card qpid_e 0 (-1073, BOARD_ALREADY_OPEN). Nothing of it was touched. Its library is loaded in …"
std::string who_has(const Settings& settings, const Library& library, int32_t native);

/// Other processes of this computer that have a library loaded, each as "4711 (loopwright deploy …)".
/// Processes of other users are visible only to root.
std::vector<std::string> processes_with(const std::string& library);

}  // namespace loopwright::hw::quanser
