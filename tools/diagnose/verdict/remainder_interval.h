/// When the remainder occurs.
#pragma once
#include <optional>
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

/// The shortest time that holds most of the squared errors of the record that has most of them, if it is a
/// small part of the record: an emergency stop, a push, a closed brake. Otherwise empty. `record` counts from
/// 1.
std::optional<RemainderInterval> interval_of_remainder(const Trials& trials,
                                                       const std::vector<Fitted>& fitted);

}  // namespace loopwright::diagnosis
