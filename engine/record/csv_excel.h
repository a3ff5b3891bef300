/// Recordings as tables for spreadsheets that expect a decimal comma.
#pragma once
#include <cstdio>
#include <string>

#include "engine/record/recording.h"

namespace loopwright {

/// Semicolons between cells, decimal commas, CRLF, a byte order mark, one heading "name [unit]", no comments
/// and no facts; a value that is not finite is an empty cell. Throws as write_csv.
void write_excel_csv(const std::string& path, const Recording& recording);

/// The same text to an open stream. Throws std::runtime_error if writing fails.
void print_excel_csv(std::FILE* stream, const Recording& recording);

}  // namespace loopwright
