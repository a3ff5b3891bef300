#include <fmt/format.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "engine/record/atomic_file.h"
#include "engine/record/csv.h"
#include "engine/record/csv_syntax.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

/// Would be read differently in a file without the signature.
bool needs_signature(const Column& column) {
  return escape(column.name) != column.name || escape(column.unit, "[]") != column.unit ||
         csv::looks_like_number(column.name);
}

std::string heading(const Column& column, bool with_escapes) {
  std::string text = with_escapes ? escape(column.name) : column.name;
  const bool name_seems_to_have_unit = csv::read_heading(text).name != text;
  if (!column.unit.empty() || name_seems_to_have_unit) {
    text += " [";
    text += with_escapes ? escape(column.unit, "[]") : column.unit;
    text += ']';
  }
  const bool must_be_quoted = text.find_first_of(",;\"") != std::string::npos || text.starts_with('#');
  if (!must_be_quoted) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string_view("\"\"") : std::string_view(&c, 1);
  return quoted + '"';
}

std::string header(const Recording& recording) {
  const bool with_signature =
      !recording.facts.empty() || std::ranges::any_of(recording.columns, needs_signature);
  std::string text;
  if (with_signature) text.append(csv::signature) += '\n';
  for (const auto& [key, value] : recording.facts) {
    text += "# " + escape(key, ":") + ":";
    if (!value.empty()) text += " " + escape(value);
    text += '\n';
  }
  for (const Column& column : recording.columns) {
    if (&column != &recording.columns.front()) text += ',';
    text += heading(column, with_signature);
  }
  return text += '\n';
}

/// Passes the text to `write(std::string_view)` in pieces.
template <class Write> void put(const Recording& recording, Write&& write) {
  check_recording(recording);
  std::string text = header(recording);
  for (size_t row = 0; row < recording.rows(); ++row) {
    for (const Column& column : recording.columns) {
      append_number(text, column.values[row]);
      text += ',';
    }
    text.back() = '\n';
    if (text.size() >= written_piece) {
      write(text);
      text.clear();
    }
  }
  write(text);
}

}  // namespace

void write_csv(const std::string& path, const Recording& recording) {
  AtomicFile file(path);
  put(recording, [&](std::string_view text) { file.write(text); });
  file.commit();
}

CsvWriter::CsvWriter(const std::string& path, const Recording& heading) : file_(path) {
  check_recording(heading);
  text_ = header(heading);
}

void CsvWriter::add(std::span<const double> row) {
  for (const double value : row) {
    append_number(text_, value);
    text_ += ',';
  }
  text_.back() = '\n';
  if (text_.size() < written_piece) return;
  file_.write(text_);
  text_.clear();
}

void CsvWriter::commit() {
  file_.write(text_);
  text_.clear();
  file_.commit();
}

void print_csv(std::FILE* stream, const Recording& recording) {
  put(recording, [&](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stream); });
  if (std::fflush(stream) != 0 || std::ferror(stream))
    throw std::runtime_error(
        fmt::format("the recording cannot be printed: {}",
                    errno == EBADF ? "the standard output is closed" : std::strerror(errno ? errno : EIO)));
}

}  // namespace loopwright
