/// Describes errors of a command line in the style of all other messages.
#pragma once
#include <CLI/CLI.hpp>
#include "engine/json/problem.h"

namespace loopwright {

/// Called after `app` failed to parse its arguments. Returns every unknown option, or else the first other
/// error.
Problems explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace loopwright
