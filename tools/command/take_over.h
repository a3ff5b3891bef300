/// Asks for agreement before a device is taken over from another program.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace loopwright {

/// Options --take-over and --yes of a subcommand.
struct TakeOver {
  bool is_wanted = false, is_agreed = false;
};

void add_take_over(CLI::App& command, TakeOver& options);

/// Reports on stderr which program has the device and what taking it over does, and asks on the terminal.
/// Without a terminal only --yes agrees. An interrupted question counts as no.
bool agrees(
    const TakeOver& options, const std::string& who_has_it, const std::string& what_it_does,
    const std::function<bool()>& is_interrupted = [] { return false; });

}  // namespace loopwright
