/// Shared by reading and writing of CSV: headings, numbers, fields.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::csv {

/// The first line of a file with escaped names and facts.
inline constexpr std::string_view signature = "# loopwright recording: 1";

/// "stage.position [m]" → name and unit. The unit may follow without a blank ("t[s]"). A number in brackets
/// is an index. No brackets: no unit.
struct Heading {
  std::string_view name, unit;
};
Heading split_heading(std::string_view text);

/// The same for files of other programs, which also write "x (mm)", "x/mm", "v/(m/s)" and "x, mm". Only a
/// unit that can be read is taken as one, and only where the heading has no other reading: x(t), max(F), u/2,
/// km/h and "y (raw)" are names without unit. "[-]" is the unit 1.
Heading read_heading(std::string_view text);

/// Whether the last word of a name is probably its unit. A product that is written without a sign, such as
/// Nm, is one, too: its use is then refused with the right spelling. Words such as "raw" are no units, and
/// neither are pure numbers, nor single letters such as d and a, which are rather names than days and ares.
/// "min" is the minimum unless it belongs to a time.
bool is_unit_of(std::string_view name, std::string_view unit);

/// The number that makes up the whole of `text`, except for surrounding blanks and a leading +; nothing if
/// the text is not a number or is beyond the range of a double.
std::optional<double> parse_number(std::string_view text);

/// A number, possibly with a decimal comma.
bool looks_like_number(std::string_view text);
/// The number that replacing its single comma by a point gives; nothing if that is none.
std::optional<double> parse_decimal_comma(std::string_view text);

struct Field {
  std::string_view text;    ///< without surrounding blanks and without its quotes
  bool quoted = false;      ///< a doubled quote inside means one quote
  bool open_quote = false;  ///< the closing quote is missing
};
/// The fields of a line. A blank as separator means any number of blanks.
std::vector<Field> split(std::string_view line, char separator);

/// The content of a field, with doubled quotes reduced to single ones.
std::string content(const Field& field);

/// The separator that gives header and first row the same number of fields, tried in the order tab,
/// semicolon, comma, blanks. If none does, the first of them (except blanks) in the header; otherwise a
/// comma.
char find_separator(std::string_view header, std::string_view first_row);
/// The separator that a first line such as "sep=;" states; nothing if the line is another.
std::optional<char> stated_separator(std::string_view line);

}  // namespace loopwright::csv
