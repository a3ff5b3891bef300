#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <ranges>

#include "engine/record/csv_reader.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

std::string counted(size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace

void CsvReader::read_row(std::string_view line) {
  if (empty_line_.data()) {
    problems_.error(at(empty_line_), "an empty line within the table", {}, {},
                    "a lost row, or a second table in the same file?");
    empty_line_ = {};
  }
  const bool has_only_numbers = read_numbers(line);
  if (has_only_numbers) note_decimal_point(line);
  if (has_only_numbers || read_fields(line))
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
  nameless_is_used_ = nameless_is_used_ || (column + 1 == row_.size() && !field.text.empty());
  if (field.text.empty())
    return refuse(field, column, "an empty cell", "a number", "leave out the rows with holes");
  std::optional<double> number = csv::parse_number(field.text);
  if (number) note_decimal_point(field.text);
  if (!number) number = decimal_commas_.read(field.text);
  if (!number || field.open_quote) return explain_text(field, column);
  if (!std::isfinite(*number) && !options_.allow_not_finite)
    return refuse(field, column, "not a finite number", "a number", "leave out the rows with holes");
  row_[column] = *number;
  return true;
}

/// Points in remarks are no decimal points.
void CsvReader::note_decimal_point(std::string_view number) {
  if (decimal_point_.empty() && number.find('.') != number.npos)
    decimal_point_ = number.substr(number.find('.'));
}

bool CsvReader::explain_text(const csv::Field& field, size_t column) {
  double number = 0;
  const auto [next, error] =
      std::from_chars(field.text.data(), field.text.data() + field.text.size(), number);
  const bool out_of_range =
      error == std::errc::result_out_of_range && next == field.text.data() + field.text.size();
  if (out_of_range)
    return refuse(field, column, "a number beyond the range of a double",
                  "magnitudes from 4.9e-324 to 1.8e308");
  return refuse(field, column, "text where a number should be", "a number such as -1.5e-3");
}

/// A cell without a number is an error of the file, or a hole of its column, with which the row is read. A
/// quote that is not closed is always an error: the next lines may belong to the same text.
bool CsvReader::refuse(const csv::Field& field, size_t column, std::string_view message, std::string expected,
                       std::string hint) {
  Column& of = recording_.columns[column];
  row_[column] = std::numeric_limits<double>::quiet_NaN();
  const bool is_hole = options_.allow_holes && !field.open_quote;
  if (is_hole && of.holes.count++ >= size_t(options_.most_problems)) return true;  // counted is enough
  Problem problem;
  problem.place = at(field.text);
  problem.message = fmt::format("column \"{}\": {}", excerpt(of.name), message);
  problem.expected = std::move(expected), problem.hint = std::move(hint);
  if (!field.text.empty()) problem.found = excerpt(field.text);
  if (is_hole)
    of.holes.first.push_back(std::move(problem));
  else
    problems_.error(problem.place, problem.message, problem.expected, problem.found, problem.hint);
  return is_hole;
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

}  // namespace loopwright
