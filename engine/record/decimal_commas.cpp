#include "engine/record/decimal_commas.h"

#include <algorithm>

#include "engine/record/csv_syntax.h"

namespace loopwright::csv {
namespace {

bool is_digit(char character) { return character >= '0' && character <= '9'; }

/// True for "1,234": up to three digits that do not begin with a zero, and three behind the comma.
bool may_separate_thousands(std::string_view cell) {
  constexpr ptrdiff_t group = 3;
  const size_t comma = cell.find(',');
  const std::string_view before = cell.substr(cell.find_first_not_of("+-"), comma),
                         behind = cell.substr(comma + 1);
  const ptrdiff_t leading = std::ranges::find(before, ',') - before.begin();
  const ptrdiff_t following = std::ranges::find_if_not(behind, is_digit) - behind.begin();
  return leading > 0 && leading <= group && before.front() != '0' && following == group;
}

}  // namespace

std::optional<double> DecimalCommas::read(std::string_view cell) {
  const std::optional<double> number = parse_decimal_comma(cell);
  if (!number) return number;
  if (first_.empty()) first_ = cell;
  are_certain_ = are_certain_ || !may_separate_thousands(cell);
  return number;
}

}  // namespace loopwright::csv
