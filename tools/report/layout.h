/// What the writers of HTML and of plain text both ask of a page.
#pragma once
#include <cstddef>
#include "tools/report/report.h"

namespace loopwright::report {

/// Throws std::invalid_argument that names every plot and table whose lists do not fit together.
void check(const Page& page);

/// Whether a column holds at least one number and otherwise nothing but numbers, blanks and dashes.
bool is_numeric_column(const Table& table, std::size_t column);

}  // namespace loopwright::report
