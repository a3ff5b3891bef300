/// Formats text for display: escapes, units and numbers.
#pragma once
#include <string>
#include <string_view>
#include <span>

namespace loopwright::report {

/// Text for HTML, between tags or within a quoted attribute.
std::string escape_html(std::string_view text);

/// A JSON string with its quotes that is also harmless inside a <script> element.
std::string json_string(std::string_view text);

/// Pictures shrink with the page to this share of their size, then they scroll: their text (12 px) could not
/// be read any more.
inline constexpr double least_scale = 0.9;

/// "N*s/m" → "N·s/m", "m/s^2" → "m/s²", "um" → "µm", "ohm" → "Ω", "1" → "".
std::string readable_unit(std::string_view unit);

/// Label and unit of an axis: "Speed (m/s)"; the label alone if there is no unit.
std::string with_unit(std::string_view label, std::string_view unit);

/// Whether a table cell is a number: "12", "-3.4e-5", "12 µm", "98.2 %", "±0.3", "1.2 ± 0.1", "nan".
bool is_numeric(std::string_view cell);

/// 600000 → "600 000" (with narrow no-break spaces).
std::string grouped(std::size_t number);

/// Significant digits (7 … 17) that resolve a millionth of the span of `values`, also with a large offset.
int significant_digits(std::span<const double> values);

/// Columns that `text` occupies on a terminal: characters, not bytes.
std::size_t text_width(std::string_view text);

/// A number with a unit prefix: 1.789e-6 m → {"1.789", "µm"}. Prefixes are used for units that begin with a
/// plain name (m, N, m/s, N*m …); with other units, and kg, the number stays unchanged.
struct Quantity {
  std::string value, unit;
};
Quantity engineering(double value, std::string_view unit, int digits = 4);

/// The same as one text: "1.789 µm".
std::string shown(double value, std::string_view unit, int digits = 4);

}  // namespace loopwright::report
