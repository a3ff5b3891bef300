/// y = table(u, v), bilinear between the four points around (u, v)
///
/// `values` has a row for each breakpoint of u and a column for each breakpoint of v. Outside the
/// breakpoints: the value at the edge, extrapolation of the outermost cell, or a fault that stops the run.
#include "blocks/math/table.h"

namespace loopwright::blocks {

struct Lookup2D {
  std::vector<double> rows, columns;
  std::vector<std::vector<double>> values;
  Outside outside = Outside::hold;
  struct In {
    double u, v;
  };
  struct Out {
    double y;
  };
  struct Mode {
    int row, column;
  };
  struct Crossings {
    double row_lower, row_upper, column_lower, column_upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Reads a table with two inputs.",
        parameter(&Lookup2D::rows, "rows", "$u", "Breakpoints of u, rising"),
        parameter(&Lookup2D::columns, "columns", "$v", "Breakpoints of v, rising"),
        parameter(&Lookup2D::values, "values", "$y", "Rows of values, as in [[1, 2], [3, 4]]"),
        parameter(&Lookup2D::outside, "outside", "", "What happens beyond the breakpoints").optional(),
        input(&In::u, "u", "$u", "Where to read, over the rows"),
        input(&In::v, "v", "$v", "Where to read, over the columns"),
        output(&Out::y, "y", "$y", "What the table says"), crossing(&Crossings::row_lower, "row_lower"),
        crossing(&Crossings::row_upper, "row_upper"), crossing(&Crossings::column_lower, "column_lower"),
        crossing(&Crossings::column_upper, "column_upper"));
  }
  void check(const Checker& checker) const {
    check_breakpoints(checker, "rows", rows);
    check_breakpoints(checker, "columns", columns);
    bool fits = values.size() == rows.size();
    for (const auto& row : values) fits &= row.size() == columns.size();
    if (fits) return;
    auto& p = checker.error("values", "the table does not fit its breakpoints");
    p.expected = std::to_string(rows.size()) + " rows of " + std::to_string(columns.size()) + " numbers";
    p.found = std::to_string(values.size()) + " rows of";
    for (const auto& row : values) p.found += " " + std::to_string(row.size());
  }
  void decide(const In& in, Mode& mode) const {
    mode.row = interval_of(rows, in.u);
    mode.column = interval_of(columns, in.v);
  }
  Fault outputs(const In& in, Out& out) const {
    const double inside_u = std::clamp(in.u, rows.front(), rows.back());
    const double inside_v = std::clamp(in.v, columns.front(), columns.back());
    const bool is_outside = inside_u != in.u || inside_v != in.v;
    const double u = outside == Outside::extrapolate ? in.u : inside_u,
                 v = outside == Outside::extrapolate ? in.v : inside_v;
    const size_t i = inner_interval(rows, u), j = inner_interval(columns, v);
    const double s = (u - rows[i]) / (rows[i + 1] - rows[i]),
                 t = (v - columns[j]) / (columns[j + 1] - columns[j]);
    const double first = (1 - t) * values[i][j] + t * values[i][j + 1];
    const double second = (1 - t) * values[i + 1][j] + t * values[i + 1][j + 1];
    out.y = (1 - s) * first + s * second;
    return fault_if(is_outside && outside == Outside::fault, "an input lies outside of the table");
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.row_lower = above_border(rows, mode.row, in.u);
    value.row_upper = below_border(rows, mode.row, in.u);
    value.column_lower = above_border(columns, mode.column, in.v);
    value.column_upper = below_border(columns, mode.column, in.v);
  }
};
LOOPWRIGHT_BLOCK(Lookup2D)

}  // namespace loopwright::blocks
