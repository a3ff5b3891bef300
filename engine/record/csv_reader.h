/// The reader of CSV in one pass: csv_read.cpp has the structure of the file, csv_rows.cpp its rows and
/// cells.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/json/problem_limit.h"
#include "engine/record/csv_syntax.h"
#include "engine/record/decimal_commas.h"
#include "engine/record/recording.h"

namespace loopwright {

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
  void take_separator();
  void name_columns(const std::vector<csv::Field>& fields);
  void distinguish_columns(const std::vector<csv::Field>& fields);
  bool may_be_left_out(const csv::Field& field, const std::vector<csv::Field>& fields);
  void leave_out_nameless_column();
  void reserve_rows();

  void read_row(std::string_view line);
  bool read_numbers(std::string_view line);
  bool read_fields(std::string_view line);
  void explain_length(std::string_view line, const std::vector<csv::Field>& fields);
  bool read_cell(const csv::Field& field, size_t column);
  bool refuse(const csv::Field& field, size_t column, std::string_view message, std::string expected,
              std::string hint = {});
  bool explain_text(const csv::Field& field, size_t column);
  void note_decimal_point(std::string_view number);
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
  std::optional<char> stated_separator_;  ///< by the line "sep=;" of Excel
  bool signed_ = false;                   ///< begins with csv::signature: names and facts are escaped
  std::string_view comment_above_;
  std::optional<std::string_view> nameless_heading_;  ///< of the last column, behind a separator too many
  bool nameless_is_used_ = false;                     ///< a cell of the last column has text
  std::string_view empty_line_;  ///< the last one within the table; an error if rows follow
  bool header_was_last_ = false;
  csv::DecimalCommas decimal_commas_;
  std::string_view decimal_point_;  ///< the first one in a row
  std::vector<double> row_;
  Recording recording_;
};

}  // namespace loopwright
