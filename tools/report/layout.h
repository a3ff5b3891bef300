/// Functions on pages shared by the writers of HTML and of plain text.
#pragma once
#include <cstddef>
#include "tools/report/report.h"

namespace loopwright::report {

/// Throws std::invalid_argument that names every plot and table with inconsistent list lengths.
void check(const Page& page);

/// Whether a column contains at least one number and otherwise only numbers, blanks and dashes.
bool is_numeric_column(const Table& table, std::size_t column);

}  // namespace loopwright::report
