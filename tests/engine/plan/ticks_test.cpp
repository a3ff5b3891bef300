// Times as exact fractions, and times that have no exact fraction.
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <numbers>
#include "engine/plan/ticks.h"

namespace loopwright::ticks_test {
namespace {

TEST(Ticks, ANumberBecomesTheSimplestFractionNearIt) {
  EXPECT_EQ(to_fraction(0), (Fraction{0, 1}));
  EXPECT_EQ(to_fraction(0.001), (Fraction{1, 1000}));
  EXPECT_EQ(to_fraction(0.0025), (Fraction{1, 400}));
  EXPECT_EQ(to_fraction(0.000666666), (Fraction{333333, 500000000})) << "a decimal, and no simple fraction";
  EXPECT_EQ(to_fraction(0.004666662), (Fraction{2333331, 500000000})) << "seven times as much";
  EXPECT_EQ(to_fraction(1.0 / 3000), (Fraction{1, 3000}));
  EXPECT_EQ(to_fraction(2.0 / 3), (Fraction{2, 3}));
  EXPECT_EQ(to_fraction(1e-6), (Fraction{1, 1'000'000}));
  EXPECT_EQ(to_fraction(1e-9), (Fraction{1, 1'000'000'000}));
  EXPECT_EQ(to_fraction(24.84), (Fraction{621, 25}));
  EXPECT_EQ(to_fraction(1e6), (Fraction{1'000'000, 1}));
  EXPECT_EQ(to_fraction(1e12), (Fraction{1'000'000'000'000, 1}));
  EXPECT_EQ(to_fraction(1e9 + 0.001), (Fraction{1'000'000'000'001, 1000})) << "a millisecond is not lost";
  EXPECT_EQ(to_fraction(1e11 + 0.25), (Fraction{400'000'000'001, 4}));
}

TEST(Ticks, EveryReciprocalOfAWholeRateIsExact) {
  for (int64_t rate = 1; rate <= 100'000; ++rate)
    ASSERT_EQ(to_fraction(1.0 / double(rate)), (Fraction{1, rate})) << rate;
}

TEST(Ticks, RoundingOfAQuotientDoesNotMatter) {
  double sum = 0;
  for (int i = 0; i < 10; ++i) sum += 0.1;  // 0.9999999999999999
  ASSERT_NE(sum, 1.0);
  EXPECT_EQ(to_fraction(sum), (Fraction{1, 1}));
}

TEST(Ticks, WhatIsNoTimeHasNoFraction) {
  for (double x : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), -0.5e-300, 1e13, 1e-10})
    EXPECT_FALSE(to_fraction(x)) << x;
}

TEST(Ticks, TheCommonDivisorDividesBothAndNoLargerTimeDoes) {
  EXPECT_EQ(common_divisor({1, 1000}, {1, 400}), (Fraction{1, 2000}));
  EXPECT_EQ(common_divisor({1, 1000}, {1, 3000}), (Fraction{1, 3000}));
  EXPECT_EQ(common_divisor({3, 10}, {1, 2}), (Fraction{1, 10}));
  EXPECT_EQ(common_divisor({2, 3}, {4, 9}), (Fraction{2, 9}));
  EXPECT_EQ(common_divisor({0, 1}, {7, 9}), (Fraction{7, 9})) << "zero is a multiple of everything";
  EXPECT_EQ(common_divisor({7, 9}, {0, 1}), (Fraction{7, 9}));
}

TEST(Ticks, ACommonDivisorBeyond64BitsIsNone) {
  EXPECT_FALSE(common_divisor({1, 6'000'000'000'000'000'001}, {1, 5'999'999'999'999'999'999}));
}

TEST(Ticks, RatiosAreWholeOrNone) {
  EXPECT_EQ(whole_ratio({1, 400}, {1, 2000}), 5);
  EXPECT_EQ(whole_ratio({0, 1}, {1, 2000}), 0);
  EXPECT_FALSE(whole_ratio({1, 1000}, {1, 400}));
  EXPECT_FALSE(whole_ratio({1, 1}, {0, 1})) << "nothing is a multiple of zero";
}

TEST(Ticks, TimeOfATickIsTheNearestNumberHoweverManyTicksHavePassed) {
  const TickClock tenths{{1, 10}}, thirds{{1, 3000}};
  for (int64_t tick : {1, 3, 7, 101, 12'345, 1'000'000, 123'456'789}) {
    EXPECT_EQ(tenths.time(tick), double(tick) / 10) << tick;
    EXPECT_EQ(thirds.time(tick), double(tick) / 3000) << tick;
  }
}

}  // namespace
}  // namespace loopwright::ticks_test
