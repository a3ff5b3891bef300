/// The ends of a parameter's range, which may depend on the quantities of a record.
#pragma once
#include "engine/json/reader.h"
#include "tools/effects/effect.h"

namespace loopwright {

/// The record of a plausible machine.
RecordSizes example_sizes();

/// A number, or an expression over record quantities whose unit must be that of the parameter. Returns its
/// value for a plausible machine, to check that a range makes sense. 0 after a problem.
double example_of_bound(const Value& value, const std::string& unit, const Reader& reader);

}  // namespace loopwright
