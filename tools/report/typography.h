/// Text made fit for its place: escapes, units and numbers as a reader expects them.
#pragma once
#include <string>
#include <string_view>
#include <span>

namespace loopwright::report {

/// Text for HTML, between tags or within a quoted attribute.
std::string escape_html(std::string_view text);

/// A JSON string with its quotes that is also harmless inside a <script> element.
std::string json_string(std::string_view text);

/// "N*s/m" → "N·s/m", "m/s^2" → "m/s²", "um" → "µm", "ohm" → "Ω", "1" → "".
std::string readable_unit(std::string_view unit);

/// Label and unit as on an axis: "Speed (m/s)"; the label alone without a unit.
std::string with_unit(std::string_view label, std::string_view unit);

/// Whether a table cell reads as a number: "12", "-3.4e-5", "12 µm", "98.2 %", "±0.3", "1.2 ± 0.1", "nan".
bool is_numeric(std::string_view cell);

/// 600000 → "600 000" (with narrow no-break spaces).
std::string grouped(std::size_t number);

/// Significant digits (7 … 17) that resolve a millionth of the span of `values`, also on top of a large
/// offset.
int significant_digits(std::span<const double> values);

/// Columns that `text` takes on a terminal: characters, not bytes.
std::size_t text_width(std::string_view text);

/// A number as an engineer writes it: 1.789e-6 m → {"1.789", "µm"}. Prefixes go before units that begin with
/// a plain name (m, N, m/s, N*m …); others, and kg, keep the number as it is.
struct Quantity {
  std::string value, unit;
};
Quantity engineering(double value, std::string_view unit, int digits = 4);

}  // namespace loopwright::report
