/// Describes errors of a command line in the style of all other messages.
#pragma once
#include <CLI/CLI.hpp>
#include "engine/json/problem.h"

namespace loopwright {

/// Called after `app` failed to parse its arguments. Returns every unknown option, or else the first other
/// error.
Problems explain(const CLI::App& app, const CLI::ParseError& error);

/// Throws InputError for empty values, numbers that are not finite or do not fit, and outputs of the chosen
/// command that are the same file as another output or an input. Existing files of outputs are reserved
/// (engine/file/output_files.h): the command cannot read them as its data either.
void check_values(const CLI::App& app);

}  // namespace loopwright
