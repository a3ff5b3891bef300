#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::lookup_2d_test {

namespace {

double read(BlockUnderTest& table, double u, double v) {
  table.input("u") = u;
  table.input("v") = v;
  table.evaluate();
  return table.output("y");
}
std::string settings(const std::string& more = "") {
  return R"({"rows": [0, 1, 3], "columns": [10, 20], "values": [[1, 2], [3, 8], [5, 6]])" + more + "}";
}

}  // namespace

TEST(Lookup2D, ReadsItsPointsExactly) {
  BlockUnderTest table("Lookup2D", settings());
  const double rows[] = {0, 1, 3}, columns[] = {10, 20}, values[3][2] = {{1, 2}, {3, 8}, {5, 6}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) EXPECT_EQ(read(table, rows[i], columns[j]), values[i][j]);
}

/// Interpolation of a bilinear function is exact.
TEST(Lookup2D, IsExactForABilinearFunction) {
  const auto f = [](double u, double v) { return 2 - u + 0.5 * v + 0.25 * u * v; };
  std::string text = R"({"rows": [-1, 0.5, 4], "columns": [0, 3, 5], "outside": "extrapolate", "values": [)";
  for (double u : {-1.0, 0.5, 4.0}) {
    text += u == -1 ? "[" : ", [";
    for (double v : {0.0, 3.0, 5.0}) text += (v == 0 ? "" : ", ") + std::to_string(f(u, v));
    text += "]";
  }
  BlockUnderTest table("Lookup2D", text + "]}");
  for (double u : {-3.0, -0.3, 0.7, 3.9, 6.0})
    for (double v : {-1.0, 0.1, 2.9, 4.4, 9.0})
      EXPECT_NEAR(read(table, u, v), f(u, v), 1e-12) << u << " " << v;
}

TEST(Lookup2D, HoldsTheEdgeBeyondItsEnds) {
  BlockUnderTest table("Lookup2D", settings());
  EXPECT_EQ(read(table, -5, 15), 1.5);
  EXPECT_EQ(read(table, 50, 50), 6);
}

TEST(Lookup2D, StopsTheRunBeyondItsEndsWhenToldTo) {
  BlockUnderTest table("Lookup2D", settings(R"(, "outside": "fault")"));
  read(table, 3, 20);
  EXPECT_EQ(table.fault(), "");
  read(table, 2, 20.1);
  EXPECT_EQ(table.fault(), "an input lies outside of the table");
}

TEST(Lookup2D, PassingABreakpointIsACrossing) {
  BlockUnderTest table("Lookup2D", settings());
  read(table, 0.9, 15);
  table.input("u") = 1.1;
  table.crossings();
  EXPECT_GT(table.crossing("row_upper"), 0);
  EXPECT_LT(table.crossing("column_upper"), 0);
  EXPECT_GT(table.crossing("column_lower"), 0);
}

TEST(Lookup2D, RefusesATableThatDoesNotFit) {
  BlockUnderTest table("Lookup2D", R"({"rows": [0, 1], "columns": [0, 1], "values": [[1, 2], [3]]})");
  const std::string text = table.problems().text();
  EXPECT_NE(text.find("2 rows of 2 numbers"), std::string::npos) << text;
  EXPECT_NE(text.find("2 rows of 2 1"), std::string::npos) << text;
}

}  // namespace loopwright::lookup_2d_test
