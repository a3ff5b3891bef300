/// The ends of a parameter's range, which may depend on the sizes of a record.
#pragma once
#include "engine/json/reader.h"
#include "tools/effects/effect.h"

namespace loopwright {

/// A number, or an expression over sizes whose unit must be that of the parameter: its value for a machine as
/// there might be, to see whether a range makes sense. 0 after a problem.
double example_of_bound(const Value& value, const std::string& unit, const Reader& reader);

}  // namespace loopwright
