/// When a subdiagram runs, if it does not run all the time.
#pragma once
#include <memory>
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// The condition among the keys of a subdiagram: "enabled_by", "triggered_by", "edge" and "while_disabled".
/// Null if it runs all the time, and after a problem.
std::shared_ptr<const RunCondition> read_run_condition(const Value& body, const Reader& reader);

}  // namespace loopwright
