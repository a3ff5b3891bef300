/// Describes errors of a command line in the style of all other messages.
#pragma once
#include <CLI/CLI.hpp>
#include "engine/json/problem.h"

namespace loopwright {

/// Called after `app` failed to parse its arguments. Returns every unknown option, or else the first other
/// error.
Problems explain(const CLI::App& app, const CLI::ParseError& error);

/// Throws InputError for empty values, and for outputs of the chosen command with the path of another output
/// or of an input.
void check_values(const CLI::App& app);

}  // namespace loopwright
