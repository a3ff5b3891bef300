/// Examples in the --help of every command.
#pragma once
#include <CLI/CLI.hpp>

namespace loopwright {

/// Adds command lines to the end of the help of each subcommand. Called when all are added.
void add_examples(CLI::App& app);

}  // namespace loopwright
