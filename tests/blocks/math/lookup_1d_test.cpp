#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::lookup_1d_test {

namespace {

double read(BlockUnderTest& table, double u) {
  table.input("u") = u;
  table.evaluate();
  return table.output("y");
}

}  // namespace

TEST(Lookup1D, JoinsItsValuesByStraightLines) {
  BlockUnderTest table("Lookup1D", R"({"breakpoints": [0, 1, 3], "values": [10, 20, 0]})");
  EXPECT_EQ(read(table, 0), 10);
  EXPECT_EQ(read(table, 0.25), 12.5);
  EXPECT_EQ(read(table, 1), 20);
  EXPECT_EQ(read(table, 2), 10);
  EXPECT_EQ(read(table, 3), 0);
}

TEST(Lookup1D, HoldsTheLastValueBeyondItsEnds) {
  for (const char* kind : {"linear", "monotone_cubic"}) {
    BlockUnderTest table("Lookup1D",
                         R"({"breakpoints": [0, 1, 3], "values": [10, 20, 0], "interpolation": ")" +
                             std::string(kind) + "\"}");
    EXPECT_EQ(read(table, -5), 10);
    EXPECT_EQ(read(table, 50), 0);
    EXPECT_EQ(table.fault(), "");
  }
}

TEST(Lookup1D, ContinuesStraightWhenToldTo) {
  BlockUnderTest line("Lookup1D",
                      R"({"breakpoints": [0, 1, 3], "values": [10, 20, 0], "outside": "extrapolate"})");
  EXPECT_EQ(read(line, -1), 0);
  EXPECT_EQ(read(line, 4), -10);
  BlockUnderTest curve(
      "Lookup1D",
      R"({"breakpoints": [0, 1, 3], "values": [10, 20, 0], "outside": "extrapolate", "interpolation": "monotone_cubic"})");
  const double slope = (read(curve, 3) - read(curve, 3 - 1e-6)) / 1e-6;
  EXPECT_NEAR(read(curve, 5), 2 * slope, 1e-3);
}

TEST(Lookup1D, StopsTheRunBeyondItsEndsWhenToldTo) {
  BlockUnderTest table("Lookup1D", R"({"breakpoints": [0, 1], "values": [1, 2], "outside": "fault"})");
  read(table, 1);
  EXPECT_EQ(table.fault(), "");
  read(table, 1.001);
  EXPECT_EQ(table.fault(), "the input lies outside of the table");
}

/// Fritsch-Butland slopes and the coefficients of the pieces in powers of t, computed in rational arithmetic.
TEST(Lookup1D, CubicPiecesAgreeWithExactArithmetic) {
  BlockUnderTest table(
      "Lookup1D",
      R"({"breakpoints": [0, 1, 1.5, 4, 5], "values": [0, 2, 2.5, 2, 5], "interpolation": "monotone_cubic"})");
  const double u[] = {0.25, 0.75, 1.25, 2.0, 3.0, 4.5, 4.75},
               expected[] = {0.6272321428571429, 1.6316964285714286, 2.330357142857143, 2.448, 2.176,
                             3.0107142857142857, 3.9808035714285714};
  for (size_t i = 0; i < std::size(u); ++i) EXPECT_NEAR(read(table, u[i]), expected[i], 1e-14) << u[i];
}

TEST(Lookup1D, CubicPiecesAreSmoothAndDoNotOvershoot) {
  BlockUnderTest table(
      "Lookup1D",
      R"({"breakpoints": [0, 1, 2, 3, 4], "values": [0, 0, 1, 1, 5], "interpolation": "monotone_cubic"})");
  const double h = 1e-4;
  double last = read(table, 0), last_slope = 0;
  for (double u = h; u < 4; u += h) {
    const double y = read(table, u), slope = (y - last) / h;
    ASSERT_GE(slope, -1e-10) << u;
    ASSERT_NEAR(slope, last_slope, 5e-3) << u;  // a kink between straight lines would show as 1 or 4
    last = y, last_slope = slope;
  }
  EXPECT_EQ(read(table, 0.5), 0);
  EXPECT_EQ(read(table, 2.5), 1);
}

TEST(Lookup1D, PassingABreakpointIsACrossing) {
  BlockUnderTest table("Lookup1D", R"({"breakpoints": [0, 1, 3], "values": [10, 20, 0]})");
  read(table, 0.9);
  table.input("u") = 1.1;
  table.crossings();
  EXPECT_GT(table.crossing("upper"), 0);
  EXPECT_GT(table.crossing("lower"), 0);
  read(table, -1);
  table.crossings();
  EXPECT_GT(table.crossing("lower"), 0);
  EXPECT_LT(table.crossing("upper"), 0);
}

TEST(Lookup1D, RefusesTablesThatAreNone) {
  const auto text = [](const char* settings) {
    return BlockUnderTest("Lookup1D", settings).problems().text();
  };
  EXPECT_NE(text(R"({"breakpoints": [0], "values": [1]})").find("at least two breakpoints"),
            std::string::npos);
  EXPECT_NE(text(R"({"breakpoints": [0, 2, 2], "values": [1, 2, 3]})").find("2, 2 at index 2"),
            std::string::npos);
  EXPECT_NE(text(R"({"breakpoints": [0, 1], "values": [1, 2, 3]})").find("as many values as breakpoints"),
            std::string::npos);
}

}  // namespace loopwright::lookup_1d_test
