// Tables and plots of recordings with rows that hold no number.
#include "tools/run/scopes.h"
#include <gtest/gtest.h>
#include <cmath>

namespace loopwright::scopes_test {
namespace {

Recording with_gaps() {
  Recording r;
  r.columns = {{"time", "s", {0, 1, 2, 3}},
               {"a", "m", {NAN, 3, -4, NAN}},
               {"note", "", {NAN, NAN, NAN, NAN}},
               {"b", "m", {1, 2, 3, 4}}};
  return r;
}

TEST(SignalTable, FiguresAreThoseOfTheNumbersAndTheOthersAreCounted) {
  const Recording r = with_gaps();
  const report::Table table = signal_table({{"a.csv", &r}});
  EXPECT_EQ(table.head.back(), "Rows without a number");
  ASSERT_EQ(table.rows.size(), 3u);
  // The mean of 3 and -4, and the root of (9 + 16) / 2.
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"a", "m", "-4", "3", "-0.5", "3.5355", "–", "2"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"note", "", "–", "–", "–", "–", "–", "4"}));
  EXPECT_EQ(table.rows[2], (std::vector<std::string>{"b", "m", "1", "4", "2.5", "2.7386", "4", "0"}));
}

TEST(SignalTable, CountsNothingWhereEveryRowHoldsANumber) {
  Recording r = with_gaps();
  r.columns.erase(r.columns.begin() + 1, r.columns.begin() + 3);
  EXPECT_EQ(signal_table({{"a.csv", &r}}).head.back(), "Last");
}

TEST(Scopes, ColumnsWithoutANumberAreNotDrawn) {
  const Recording r = with_gaps();
  size_t curves = 0;
  for (const report::Plot& plot : scopes({{"a.csv", &r}}, [](const std::string&) { return false; }))
    for (const report::Series& series : plot.series) {
      EXPECT_NE(series.name, "note");
      ++curves;
    }
  EXPECT_EQ(curves, 2u);
}

}  // namespace
}  // namespace loopwright::scopes_test
