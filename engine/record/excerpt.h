/// Which part of a recording is used, and what its columns mean: the keys "columns" and "excerpt" of an
/// experiment file.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/json/file_shape.h"
#include "engine/json/reader.h"
#include "engine/json/stated_number.h"
#include "engine/record/column_units.h"
#include "engine/record/recording.h"

namespace loopwright {

///     "columns": {"x": {"column": "data[1]", "scale": -2e-6, "offset": "3 mm", "unit": "m"},
///                 "u": {"rows_late": 1}},
///     "excerpt": {"skip": 100, "from": "2 s", "to": 10, "decimate": 4}
///
/// value = scale · number in the file + offset, in the unit; a column gets its new name. One that was logged
/// some rows late gets the number of so many rows after; the last rows, to which no number belongs then, are
/// left out. Of the others the first ones are left out, then those outside of the times, and of the rest
/// every n-th is kept.
class Excerpt {
 public:
  /// What stands at a name in "columns", and at "excerpt".
  static FileShape column_shape();
  static FileShape rows_shape();
  /// Reads both keys, where present.
  static Excerpt read(const Value& file, const Reader& reader);

  bool empty() const { return columns_.empty() && !has_rows_; }
  /// Changes the recording. `time`: as for time_in_seconds(); a new name is allowed. Reports problems at the
  /// places of the keys.
  void apply(Recording& recording, const std::string& time, const Reader& reader) const;

 private:
  struct NewColumn {
    std::string name, column, unit;
    double scale = 1;
    std::optional<StatedNumber> offset;
    size_t rows_late = 0;
    bool is_computed = false;  ///< states a scale or an offset
    Place place;
    Value at;
  };
  static std::optional<NewColumn> read_column(const Value::Member& entry, const Reader& reader);
  void read_rows(const Value::Member& excerpt, const Reader& reader);
  static std::optional<Column> computed(const NewColumn& wanted, const Column& from, const Reader& reader);
  /// With the rows to which its numbers belong; an error where one of them is missing.
  static std::optional<Column> column_moved(const Recording& recording, const NewColumn& wanted,
                                            const ColumnError& error);
  void add_columns(Recording& recording, const Reader& reader) const;
  void leave_out_rows_without_number(Recording& recording, const Reader& reader) const;
  void keep_rows(Recording& recording, const std::string& time, const Reader& reader) const;

  std::vector<NewColumn> columns_;
  bool has_rows_ = false;
  double from_ = -Reader::infinity, to_ = Reader::infinity;  ///< [s]
  size_t skip_ = 0, decimate_ = 1;
  Value rows_at_;
};

/// Each row with the value of so many rows after it; the last value stays.
std::vector<double> moved_earlier(const std::vector<double>& values, size_t rows);

}  // namespace loopwright
