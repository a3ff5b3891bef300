/// What is wrong with a command line, in the words of all other messages.
#pragma once
#include <CLI/CLI.hpp>
#include "engine/json/problem.h"

namespace loopwright {

/// After `app` could not parse its arguments: every option that does not exist, or else the first other
/// mistake.
Problems explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace loopwright
