/// The object "solver" of a diagram file.
#pragma once
#include "engine/diagram/diagram.h"
#include "engine/diagram/parameter_scope.h"
#include "engine/json/file_shape.h"

namespace loopwright {

/// The keys of "solver".
FileShape solver_shape();

/// Reads every key, checks its range and unit, and rejects unknown keys.
SolverSettings read_solver_settings(const Value& object, ParameterScope& scope, const Reader& reader);

/// A number in s, for sample times and steps. Nothing after a problem.
std::optional<Value> read_time(const Value& value, std::string_view what, ParameterScope& scope,
                               const Reader& reader);

}  // namespace loopwright
