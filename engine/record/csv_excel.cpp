#include "engine/record/csv_excel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/record/atomic_file.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

std::string quoted_heading(const Column& column) {
  std::string text = "\"";
  for (const char c : column.name + (column.unit.empty() ? "" : " [" + column.unit + "]"))
    text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

void append_cell(std::string& text, double value) {
  if (!std::isfinite(value)) return;
  const size_t begin = text.size();
  append_number(text, value);
  std::replace(text.begin() + std::ptrdiff_t(begin), text.end(), '.', ',');
}

/// Passes the text to `write(std::string_view)` in pieces.
template <class Write> void put_excel(const Recording& recording, Write&& write) {
  check_recording(recording);
  std::string text = "\xEF\xBB\xBF";  // Excel takes text without it as that of an old code page
  for (const Column& column : recording.columns) {
    if (&column != &recording.columns.front()) text += ';';
    text += quoted_heading(column);
  }
  text += "\r\n";
  for (size_t row = 0; row < recording.rows(); ++row) {
    for (const Column& column : recording.columns) {
      if (&column != &recording.columns.front()) text += ';';
      append_cell(text, column.values[row]);
    }
    text += "\r\n";
    if (text.size() < written_piece) continue;
    write(text);
    text.clear();
  }
  write(text);
}

}  // namespace

void write_excel_csv(const std::string& path, const Recording& recording) {
  AtomicFile file(path);
  put_excel(recording, [&](std::string_view text) { file.write(text); });
  file.commit();
}

void print_excel_csv(std::FILE* stream, const Recording& recording) {
  put_excel(recording, [&](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stream); });
  if (std::fflush(stream) != 0 || std::ferror(stream))
    throw std::runtime_error("the recording cannot be printed");
}

}  // namespace loopwright
