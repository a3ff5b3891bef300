#include "tools/report/layout.h"
#include <fmt/format.h>
#include <stdexcept>
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

void check(const Plot& plot, std::string& faults) {
  for (const Series& series : plot.series)
    if (series.x.size() != series.y.size())
      faults += fmt::format("\nplot '{}', series '{}': x has {} values, y has {}", plot.title, series.name,
                            series.x.size(), series.y.size());
}

void check(const Table& table, std::string& faults) {
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (table.rows[row].size() > table.head.size())
      faults += fmt::format("\ntable '{}', row {}: {} cells, but the head has {}", table.caption, row + 1,
                            table.rows[row].size(), table.head.size());
}

}  // namespace

void check(const Page& page) {
  std::string faults;
  for (const Section& section : page.sections)
    for (const Item& item : section.items) {
      if (const Plot* plot = std::get_if<Plot>(&item)) check(*plot, faults);
      if (const Table* table = std::get_if<Table>(&item)) check(*table, faults);
    }
  if (!faults.empty())
    throw std::invalid_argument("report page '" + page.title + "' cannot be written:" + faults);
}

bool is_numeric_column(const Table& table, std::size_t column) {
  bool any = false;
  for (const std::vector<std::string>& row : table.rows) {
    if (column >= row.size()) continue;
    const std::string& cell = row[column];
    if (cell.empty() || cell == "-" || cell == "–" || cell == "—") continue;
    if (!is_numeric(cell)) return false;
    any = true;
  }
  return any;
}

}  // namespace loopwright::report
