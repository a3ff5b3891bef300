/// Metrics that are expressions over signals: "=reference.position - stage.position".
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/formula_parser.h"
#include "engine/unit/unit.h"
#include "tools/sweep/sweep.h"

namespace loopwright {

inline bool is_expression(const std::string& signal) { return signal.starts_with('='); }

/// A parser that knows the constants of expressions and takes paths of ports as names. `half_turn` replaces
/// π, to determine its effect on the result.
FormulaParser metric_parser(double* half_turn = nullptr);

/// The ports named by a metric's signal, in a fixed order.
std::vector<std::string> ports_of(const Metric& metric, Problems& problems);

/// The unit of a metric's expression, from those of its ports. Nothing if one of them is unknown, if zero is
/// the result, or after a problem: the expression mixes units.
std::optional<Unit> unit_of_expression(const Metric& metric, const std::vector<std::string>& ports,
                                       const std::vector<std::optional<Unit>>& units, Problems& problems);

}  // namespace loopwright
