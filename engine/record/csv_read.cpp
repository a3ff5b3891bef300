#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>
#include <ranges>
#include <unordered_set>
#include <utility>

#include "engine/record/csv.h"
#include "engine/record/csv_reader.h"
#include "engine/record/recorded_bytes.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

bool is_comment(std::string_view line) { return trim(line).starts_with('#'); }

}  // namespace

Recording CsvReader::read() {
  if (!check_text()) return {};
  take_signature();
  take_separator();
  std::string_view line;
  while (next_line(line)) {
    if (!check_line(line)) return {};
    if (trim(line).empty()) {
      if (recording_.rows() > 0) empty_line_ = line;
    } else if (is_comment(line)) {
      read_comment(trim(line));
    } else if (recording_.columns.empty()) {
      begin_table(line);
    } else {
      read_row(line);
    }
  }
  if (recording_.columns.empty()) {
    problems_.error(start(), text_.empty() ? "the file is empty" : "the file has no table of numbers",
                    "a header such as time [s],position [m] and rows of numbers");
  } else if (recording_.rows() == 0 && !problems_.has_errors()) {
    problems_.error(start(), "the table has no rows", "rows of numbers below the header");
  }
  check_decimal_commas();
  leave_out_nameless_column();
  return problems_.has_errors() ? Recording{} : std::move(recording_);
}

/// Reports a file that is not text; moves the cursor past a byte order mark.
bool CsvReader::check_text() {
  if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) {
    problems_.error(start(), "the file is UTF-16 text", "UTF-8", {}, "save it again as \"CSV UTF-8\"");
    return false;
  }
  const size_t bad = find_not_text(text_);
  if (bad != std::string_view::npos) {
    const auto byte = static_cast<unsigned char>(text_[bad]);
    problems_.error(
        at(text_.substr(bad)), "the file is not UTF-8 text", "UTF-8", fmt::format("byte 0x{:02x}", byte),
        byte == 0 ? "this is a binary file, or one that was not written to its end"
                  : "this is a binary file, or text in another encoding: save it again as \"CSV UTF-8\"");
    return false;
  }
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text_.starts_with(byte_order_mark)) cursor_ = byte_order_mark.size();
  if (text_.find('\n') == std::string_view::npos) line_end_ = '\r';  // line ends of classic Mac OS
  return true;
}

void CsvReader::take_signature() {
  const size_t start_of_line = cursor_;
  std::string_view line;
  signed_ = next_line(line) && line == csv::signature;
  if (!signed_) cursor_ = start_of_line;
}

/// "sep=;", which Excel writes and obeys.
void CsvReader::take_separator() {
  const size_t start_of_line = cursor_;
  std::string_view line;
  if (!signed_ && next_line(line)) stated_separator_ = csv::stated_separator(line);
  if (!stated_separator_) cursor_ = start_of_line;
}

/// The next line without its line end; false at the end of the text.
bool CsvReader::next_line(std::string_view& line) {
  if (cursor_ >= text_.size()) return false;
  const size_t end = std::min(text_.find(line_end_, cursor_), text_.size());
  line = text_.substr(cursor_, end - cursor_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  cursor_ = end + 1;
  return true;
}

bool CsvReader::check_line(std::string_view line) {
  if (line.size() <= options_.longest_line) return true;
  problems_.error(at(line), "this line is too long for a table of numbers",
                  fmt::format("at most {} bytes", options_.longest_line),
                  fmt::format("{} bytes", line.size()));
  return false;
}

void CsvReader::read_comment(std::string_view comment) {
  const std::string_view content = trim(comment.substr(1));
  if (recording_.columns.empty()) comment_above_ = content;
  const auto literal = [this](std::string_view text) { return signed_ ? unescape(text) : std::string(text); };
  // The colon of "10:30:00" or "http://…" does not end a key.
  size_t colon = content.find(':');
  while (colon != content.npos && colon + 1 != content.size() && content[colon + 1] != ' ')
    colon = content.find(':', colon + 1);
  if (colon == content.npos) {
    recording_.facts.emplace_back("comment", literal(content));
  } else {
    recording_.facts.emplace_back(literal(trim(content.substr(0, colon))),
                                  literal(trim(content.substr(colon + 1))));
  }
}

/// The first line of the table: the names, or already the first row.
void CsvReader::begin_table(std::string_view line) {
  separator_ = signed_             ? ','
               : stated_separator_ ? *stated_separator_
                                   : csv::find_separator(line, next_table_line());
  const std::vector<csv::Field> fields = csv::split(line, separator_);
  row_.resize(fields.size());
  if (is_header(fields)) {
    name_columns(fields);
    reserve_rows();
    header_was_last_ = true;
    return;
  }
  if (!take_header_from_comment())
    for (size_t i = 1; i <= fields.size(); ++i) recording_.columns.push_back({fmt::format("c{}", i), {}, {}});
  reserve_rows();
  read_row(line);
}

/// The line after the header, without moving the cursor; empty if there is none.
std::string_view CsvReader::next_table_line() const {
  for (size_t from = cursor_; from < text_.size();) {
    const size_t end = std::min(text_.find(line_end_, from), text_.size());
    std::string_view line = text_.substr(from, end - from);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!trim(line).empty() && !is_comment(line)) return line.substr(0, options_.longest_line);
    from = end + 1;
  }
  return {};
}

/// More words than numbers: a first row with one damaged cell must not be taken as a header.
bool CsvReader::is_header(const std::vector<csv::Field>& fields) const {
  if (signed_) return true;
  ptrdiff_t words = 0, numbers = 0;
  for (const csv::Field& field : fields) {
    if (!field.text.empty()) ++(csv::looks_like_number(field.text) ? numbers : words);
  }
  return words > numbers || numbers == 0;
}

/// Names as written by gnuplot and numpy.savetxt: in the comment directly above the rows.
bool CsvReader::take_header_from_comment() {
  const std::vector<csv::Field> fields = csv::split(comment_above_, separator_);
  const bool fits = fields.size() == row_.size() && fields.size() > 1 && !recording_.facts.empty() &&
                    recording_.facts.back().first == "comment";
  if (!fits) return false;
  recording_.facts.pop_back();
  name_columns(fields);
  return true;
}

/// Columns that only their units distinguish, such as "F (N)" and "F (V)", keep their headings as names.
void CsvReader::distinguish_columns(const std::vector<csv::Field>& fields) {
  std::map<std::string, size_t> count;
  for (const Column& column : recording_.columns) ++count[column.name];
  for (size_t i = 0; i < fields.size(); ++i) {
    Column& column = recording_.columns[i];
    const std::string whole = csv::content(fields[i]);
    if (!signed_ && count[column.name] > 1 && !whole.ends_with(']')) column.name = whole;
  }
}

void CsvReader::name_columns(const std::vector<csv::Field>& fields) {
  for (const csv::Field& field : fields) {
    const std::string content = csv::content(field);
    const csv::Heading heading = signed_ ? csv::split_heading(content) : csv::read_heading(content);
    Column& column = recording_.columns.emplace_back();
    column.name = signed_ ? unescape(heading.name) : heading.name;
    column.unit = signed_ ? unescape(heading.unit) : heading.unit;
    const LineColumn place = line_column(at(field.text));
    column.origin = fmt::format("{}:{}:{}", source_->name, place.line, place.column);
  }
  distinguish_columns(fields);
  std::unordered_set<std::string> names;
  for (const csv::Field& field : fields) {
    const Column& column = recording_.columns[size_t(&field - fields.data())];
    if (field.open_quote) {
      problems_.error(at(field.text), "the quote before this column name is not closed");
    } else if (column.name.empty() && may_be_left_out(field, fields)) {
      nameless_heading_ = field.text;
    } else if (column.name.empty()) {
      problems_.error(at(field.text), fmt::format("column {} has no name", names.size() + 1), {}, {},
                      &field == &fields.back() ? "a separator too many at the end of the line?" : "");
    } else if (!names.insert(column.name).second) {
      problems_.error(at(field.text), fmt::format("two columns are named \"{}\"", excerpt(column.name)));
    }
  }
}

/// Lines that end with a separator have a last column without a name and, as its cells will show, without
/// contents.
bool CsvReader::may_be_left_out(const csv::Field& field, const std::vector<csv::Field>& fields) {
  return options_.allow_holes && !signed_ && fields.size() > 1 && &field == &fields.back() && !field.quoted;
}

void CsvReader::leave_out_nameless_column() {
  if (!nameless_heading_) return;
  const Column& nameless = recording_.columns.back();
  if (nameless_is_used_ || nameless.holes.count < nameless.values.size())
    problems_.error(at(*nameless_heading_), fmt::format("column {} has no name", recording_.columns.size()));
  recording_.columns.pop_back();
}

/// Every number needs at least two bytes of text: the reserved memory is proportional to the file.
void CsvReader::reserve_rows() {
  const std::string_view rest = text_.substr(std::min(cursor_, text_.size()));
  const size_t lines = static_cast<size_t>(std::ranges::count(rest, line_end_)) + 2;
  const size_t most = rest.size() / (2 * row_.size()) + 2;
  for (Column& column : recording_.columns) column.values.reserve(std::min(lines, most));
}

Recording parse_csv(std::shared_ptr<const SourceFile> source, Problems& problems,
                    const ReadOptions& options) {
  return CsvReader(std::move(source), problems, options).read();
}

namespace {

/// The last file without problems. A diagram asks for each of its columns by itself, and a diagnosis for all
/// of them some twenty times. The bytes are read and compared anew each time.
class LastRead {
 public:
  std::optional<Recording> find(const SourceFile& source, const ReadOptions& options) {
    const std::lock_guard lock(mutex_);
    const bool is_same =
        source_ && options_ == options &&
        (source_.get() == &source || (source_->name == source.name && source_->text == source.text));
    return is_same ? std::optional(recording_) : std::nullopt;
  }
  void keep(std::shared_ptr<const SourceFile> source, const ReadOptions& options,
            const Recording& recording) {
    if (source->text.size() > most_bytes) return;
    const std::lock_guard lock(mutex_);
    source_ = std::move(source), options_ = options, recording_ = recording;
  }

 private:
  static constexpr size_t most_bytes = 16 << 20;
  std::mutex mutex_;
  std::shared_ptr<const SourceFile> source_;
  ReadOptions options_;
  Recording recording_;
};

}  // namespace

Recording read_csv(const std::string& path, Problems& problems, const ReadOptions& options) {
  static LastRead last;
  const std::shared_ptr<const SourceFile> source = read_recorded_bytes(path, problems);
  if (!source) return {};
  if (auto known = last.find(*source, options)) return std::move(*known);
  const size_t before = problems.list().size();
  Recording recording = parse_csv(source, problems, options);
  if (problems.list().size() == before) last.keep(source, options, recording);
  return recording;
}

}  // namespace loopwright
