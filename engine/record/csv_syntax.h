/// What reading and writing of CSV agree on: headings, numbers, fields.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::csv {

/// The first line of a file whose names and facts are escaped.
inline constexpr std::string_view signature = "# loopwright recording: 1";

/// "stage.position [m]" → name and unit. The unit may follow without a blank ("t[s]"), unless it is a number:
/// then it is an index. No brackets: no unit.
struct Heading {
  std::string_view name, unit;
};
Heading split_heading(std::string_view text);

/// The number that is the whole of `text`, blanks around it and a leading + aside; nothing when it is
/// something else or beyond the range of a double.
std::optional<double> parse_number(std::string_view text);

/// A number, be it with a decimal comma.
bool looks_like_number(std::string_view text);
/// Would be a number if its one comma were a point.
bool has_decimal_comma(std::string_view text);

struct Field {
  std::string_view text;    ///< without blanks around it and without its quotes
  bool quoted = false;      ///< a doubled quote inside stands for one
  bool open_quote = false;  ///< the closing quote is missing
};
/// The fields of a line. A blank as separator means: any number of blanks.
std::vector<Field> split(std::string_view line, char separator);

/// What a field says, with doubled quotes made single.
std::string content(const Field& field);

/// The separator that gives header and first row the same number of fields, tried in the order tab,
/// semicolon, comma, blanks; if none does, the first of them (but no blanks) that the header has; else a
/// comma.
char find_separator(std::string_view header, std::string_view first_row);

}  // namespace loopwright::csv
