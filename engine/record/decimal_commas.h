/// Numbers with a decimal comma, in tables whose cells are separated otherwise.
#pragma once
#include <optional>
#include <string_view>

namespace loopwright::csv {

/// Reads cells such as "1,5" and remembers what the table shows of its commas. A single cell leaves open
/// whether "1,234" is 1.234 or 1234. "0,5", "1,25" and "1234,567" do not: their comma does not separate
/// thousands.
class DecimalCommas {
 public:
  /// The number of a cell with one comma; nothing if replacing the comma by a point gives none.
  std::optional<double> read(std::string_view cell);

  /// The first cell with a comma, whose position is that in the text; empty if there is none.
  std::string_view first() const { return first_; }
  /// True if a cell was read whose comma does not separate thousands.
  bool are_certain() const { return are_certain_; }

 private:
  std::string_view first_;
  bool are_certain_ = false;
};

}  // namespace loopwright::csv
