/// What a page must satisfy before it can be written.
#pragma once
#include "tools/report/report.h"

namespace loopwright::report {

/// Throws std::invalid_argument that names the first plot or table whose lists do not fit together.
void check(const Page& page);

}  // namespace loopwright::report
