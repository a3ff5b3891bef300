/// Whether the rows are as far apart in time as their file says.
#pragma once
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "tools/diagnose/diagnosis.h"

namespace loopwright::diagnosis {

/// A finding for each experiment whose rows are so far apart that the unit of their time is doubtful: see
/// check_unit_of_time(). Nothing for files that cannot be read. Throws InputError instead where the motion of
/// an axis is looked at: it cannot be followed from one such row to the next.
std::vector<RecordFinding> doubts_about_time(const std::string& diagram,
                                             const std::vector<std::string>& experiments,
                                             const LoadOptions& options, bool is_axis);

}  // namespace loopwright::diagnosis
