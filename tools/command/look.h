/// The subcommand `look`.
#pragma once
#include "tools/command/command.h"

namespace loopwright {

void add_look(CLI::App& app, std::function<void(std::function<int()>)> choose);

}  // namespace loopwright
