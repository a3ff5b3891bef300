/// Commands that repeat in a terminal what the studio did.
#pragma once
#include <string>
#include "engine/diagram/in_memory.h"

namespace loopwright::studio {

/// An argument for a shell.
std::string shell_word(const std::string& text);
/// " --set mass=2 --variant stage=quanser"; empty if there are none.
std::string options_text(const LoadOptions& options);

}  // namespace loopwright::studio
