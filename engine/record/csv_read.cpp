#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <ranges>
#include <unordered_set>
#include <utility>

#include "engine/record/csv.h"
#include "engine/record/csv_syntax.h"
#include "engine/record/decimal_commas.h"
#include "engine/record/recorded_bytes.h"
#include "engine/json/problem_limit.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

std::string counted(size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool is_comment(std::string_view line) { return trim(line).starts_with('#'); }

/// One pass over the text, line by line. Rows of plain numbers use the fast path read_numbers(). Any other
/// row is split into fields, each of which is checked separately.
class CsvReader {
 public:
  CsvReader(std::shared_ptr<const SourceFile> source, Problems& problems, const ReadOptions& options)
      : source_(std::move(source)),
        text_(source_->text),
        options_(options),
        problems_(problems, options.most_problems) {}

  Recording read();

 private:
  bool check_text();
  void take_signature();
  bool next_line(std::string_view& line);
  bool check_line(std::string_view line);

  void read_comment(std::string_view comment);
  void begin_table(std::string_view line);
  std::string_view next_table_line() const;
  bool is_header(const std::vector<csv::Field>& fields) const;
  bool take_header_from_comment();
  void name_columns(const std::vector<csv::Field>& fields);
  void distinguish_columns(const std::vector<csv::Field>& fields);
  void reserve_rows();

  void read_row(std::string_view line);
  bool read_numbers(std::string_view line);
  bool read_fields(std::string_view line);
  void explain_length(std::string_view line, const std::vector<csv::Field>& fields);
  bool read_cell(const csv::Field& field, size_t column);
  void explain_text(const csv::Field& field, const std::string& where);
  void check_decimal_commas();

  Place at(std::string_view part) const {
    return {source_, static_cast<uint32_t>(part.data() - text_.data())};
  }
  Place start() const { return {source_, 0}; }

  std::shared_ptr<const SourceFile> source_;
  std::string_view text_;
  const ReadOptions& options_;
  ProblemLimit problems_;

  size_t cursor_ = 0;  ///< [bytes] of the next line
  char line_end_ = '\n';
  char separator_ = ',';
  bool signed_ = false;  ///< begins with csv::signature: names and facts are escaped
  std::string_view comment_above_;
  std::string_view empty_line_;  ///< the last one within the table; an error if rows follow
  bool header_was_last_ = false;
  csv::DecimalCommas decimal_commas_;
  std::string_view decimal_point_;  ///< the first one in a row
  std::vector<double> row_;
  Recording recording_;
};

Recording CsvReader::read() {
  if (!check_text()) return {};
  take_signature();
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
  separator_ = signed_ ? ',' : csv::find_separator(line, next_table_line());
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
    } else if (column.name.empty()) {
      problems_.error(at(field.text), fmt::format("column {} has no name", names.size() + 1), {}, {},
                      &field == &fields.back() ? "a separator too many at the end of the line?" : "");
    } else if (!names.insert(column.name).second) {
      problems_.error(at(field.text), fmt::format("two columns are named \"{}\"", excerpt(column.name)));
    }
  }
}

/// Every cell needs at least two bytes of text: the reserved memory is proportional to the file.
void CsvReader::reserve_rows() {
  const std::string_view rest = text_.substr(std::min(cursor_, text_.size()));
  const size_t lines = static_cast<size_t>(std::ranges::count(rest, line_end_)) + 2;
  const size_t most = rest.size() / (2 * row_.size()) + 2;
  for (Column& column : recording_.columns) column.values.reserve(std::min(lines, most));
}

void CsvReader::read_row(std::string_view line) {
  if (empty_line_.data()) {
    problems_.error(at(empty_line_), "an empty line within the table", {}, {},
                    "a lost row, or a second table in the same file?");
    empty_line_ = {};
  }
  if (decimal_point_.empty() && line.find('.') != line.npos) decimal_point_ = line.substr(line.find('.'));
  if (read_numbers(line) || read_fields(line))
    for (size_t i = 0; i < row_.size(); ++i) recording_.columns[i].values.push_back(row_[i]);
  header_was_last_ = false;
}

/// The fast path: true if the line has only finite numbers, one for each column.
bool CsvReader::read_numbers(std::string_view line) {
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || (*at == '\t' && separator_ != '\t'))) ++at;
  };
  for (size_t column = 0; column < row_.size(); ++column) {
    if (column > 0 && separator_ != ' ') {
      if (at == end || *at != separator_) return false;
      ++at;
    }
    skip_blanks();
    const auto [next, error] = std::from_chars(at, end, row_[column]);
    if (error != std::errc() || !std::isfinite(row_[column])) return false;
    const bool ends_like_a_number = next == end || *next == separator_ || *next == ' ' || *next == '\t';
    if (!ends_like_a_number) return false;
    at = next;
    skip_blanks();
  }
  return at == end;
}

/// Field by field: true if the row is valid after all (quoted numbers, a leading plus); otherwise reports the
/// mistake.
bool CsvReader::read_fields(std::string_view line) {
  const std::vector<csv::Field> fields = csv::split(line, separator_);
  if (fields.size() != row_.size()) {
    explain_length(line, fields);
    return false;
  }
  const bool second_header = header_was_last_ && std::ranges::none_of(fields, [](const csv::Field& field) {
                               return field.text.empty() || csv::looks_like_number(field.text);
                             });
  if (second_header) {
    problems_.error(at(line), "text where the first row of numbers should be", {}, excerpt(line),
                    "a second header line? write units behind the names: position [m]");
    return false;
  }
  bool right = true;
  for (size_t i = 0; i < fields.size(); ++i) right &= read_cell(fields[i], i);
  return right;
}

void CsvReader::explain_length(std::string_view line, const std::vector<csv::Field>& fields) {
  const bool at_end_of_text = line.data() + line.size() == text_.data() + text_.size();
  std::string message = "a row of another length than the first line of the table", hint;
  if (fields.size() == 2 * row_.size() && separator_ == ',') {
    hint = "decimal commas? write 1.5 for 1,5 or separate the cells by semicolons and the decimals by points";
  } else if (fields.size() < row_.size() && at_end_of_text) {
    message = "the last row is cut off";
    hint = "was the writing of this file interrupted? remove the row to use the rest";
  } else if (fields.size() == row_.size() + 1 && fields.back().text.empty()) {
    hint = "a separator too many at the end of the line?";
  }
  problems_.error(at(line), message, counted(row_.size(), "cell"), counted(fields.size(), "cell"), hint);
}

/// Stores the number of a cell in the row; false if there is none, after reporting the reason.
bool CsvReader::read_cell(const csv::Field& field, size_t column) {
  const std::string where = fmt::format("column \"{}\": ", excerpt(recording_.columns[column].name));
  if (field.text.empty()) {
    problems_.error(at(field.text), where + "an empty cell", "a number", {},
                    "leave out rows with holes, or fill them before");
    return false;
  }
  std::optional<double> number = csv::parse_number(field.text);
  if (!number) number = decimal_commas_.read(field.text);
  if (!number || field.open_quote) {
    explain_text(field, where);
    return false;
  }
  if (!std::isfinite(*number) && !options_.allow_not_finite) {
    problems_.error(at(field.text), where + "not a finite number", "a number", excerpt(field.text),
                    "leave out rows with holes, or fill them before");
    return false;
  }
  row_[column] = *number;
  return true;
}

void CsvReader::explain_text(const csv::Field& field, const std::string& where) {
  double number = 0;
  const auto [next, error] =
      std::from_chars(field.text.data(), field.text.data() + field.text.size(), number);
  const bool out_of_range =
      error == std::errc::result_out_of_range && next == field.text.data() + field.text.size();
  problems_.error(
      at(field.text),
      where + (out_of_range ? "a number beyond the range of a double" : "text where a number should be"),
      out_of_range ? "magnitudes from 4.9e-324 to 1.8e308" : "a number such as -1.5e-3", excerpt(field.text));
}

/// Refuses a table that leaves open whether its commas are decimal commas or separate thousands.
void CsvReader::check_decimal_commas() {
  const std::string_view comma = decimal_commas_.first();
  if (comma.empty()) return;
  if (!decimal_point_.empty())
    problems_.error(
        at(comma), "numbers with commas and with points in one table",
        "only decimal commas, or only decimal points",
        fmt::format("{}, and a point in line {}", excerpt(comma), line_column(at(decimal_point_)).line),
        "do the commas separate thousands? export the file without them");
  else if (!decimal_commas_.are_certain())
    problems_.error(at(comma), "a comma that may be a decimal comma or separate thousands",
                    "a decimal point, such as 1.5", excerpt(comma),
                    "every comma of the file stands before three digits: write points instead, or nothing");
}

}  // namespace

Recording parse_csv(std::shared_ptr<const SourceFile> source, Problems& problems,
                    const ReadOptions& options) {
  return CsvReader(std::move(source), problems, options).read();
}

Recording read_csv(const std::string& path, Problems& problems, const ReadOptions& options) {
  const std::shared_ptr<const SourceFile> source = read_recorded_bytes(path, problems);
  return source ? parse_csv(source, problems, options) : Recording{};
}

}  // namespace loopwright
