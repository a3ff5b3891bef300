// Unknown units in many equations are solved together, also if every equation has several unknowns.
#include "engine/plan/unit_system.h"
#include <chrono>
#include <gtest/gtest.h>

namespace loopwright::unit_system_test {
namespace {

Unit unit(std::string_view text) { return parse_unit(text).value(); }
Unit inverse(std::string_view text) { return power(unit(text), -1); }

TEST(UnitSystem, SolvesProductsAndQuotients) {
  UnitSystem system;  // a b = m^2, a / b = 1, a b c = N
  system.add({{1, 1}, {2, 1}}, inverse("m^2"), 0);
  system.add({{1, 1}, {2, -1}}, {}, 1);
  system.add({{1, 1}, {2, 1}, {3, 1}}, inverse("N"), 2);
  system.solve();
  EXPECT_EQ(system.value(1), unit("m"));
  EXPECT_EQ(system.value(2), unit("m"));
  EXPECT_EQ(system.value(3), unit("N/m^2"));
  EXPECT_TRUE(system.contradictions().empty());
}

TEST(UnitSystem, SolvesThreeTangledUnknowns) {
  UnitSystem system;  // a b c = N, a b / c = N/s^2, a / b c = kg: c = s, b = m/s^3, a = kg m … (substituted)
  system.add({{7, 1}, {8, 1}, {9, 1}}, inverse("N"), 0);
  system.add({{7, 1}, {8, 1}, {9, -1}}, inverse("N/s^2"), 1);
  system.add({{7, 1}, {8, -1}, {9, -1}}, inverse("kg"), 2);
  system.solve();
  const Unit a = system.value(7).value(), b = system.value(8).value(), c = system.value(9).value();
  EXPECT_EQ(a * b * c, unit("N"));
  EXPECT_EQ(a * b * power(c, -1), unit("N/s^2"));
  EXPECT_EQ(a * power(b, -1) * power(c, -1), unit("kg"));
}

TEST(UnitSystem, LeavesOpenWhatNothingDecides) {
  UnitSystem system;
  system.add({{1, 1}, {2, -1}}, unit("m"), 0);
  system.add({{3, 1}, {4, 1}, {5, 1}}, {}, 1);
  system.add({{6, 2}}, inverse("m^2"), 2);
  system.solve();
  for (const size_t open : {1, 2, 3, 4, 5}) EXPECT_FALSE(system.value(open)) << open;
  EXPECT_EQ(system.value(6), unit("m"));
}

TEST(UnitSystem, NamesTheEquationThatCannotHold) {
  UnitSystem system;
  system.add({{1, 1}, {2, -1}}, unit("m"), 10);
  system.add({{2, 1}, {3, -1}}, unit("s"), 11);
  system.add({{3, 1}, {1, -1}}, unit("1"), 12);
  system.solve();
  ASSERT_EQ(system.contradictions().size(), 1u);
  EXPECT_EQ(system.contradictions()[0].equation, 12);
  EXPECT_EQ(to_string(system.contradictions()[0].rest), "m*s");
  for (const size_t unknown : {1, 2, 3}) EXPECT_FALSE(system.value(unknown)) << unknown;
}

TEST(UnitSystem, SolvesLongChainsInEitherOrder) {
  constexpr size_t links = 200'000;
  for (const bool backwards : {false, true}) {
    UnitSystem system;
    for (size_t i = 0; i < links; ++i) {
      const size_t link = backwards ? links - 1 - i : i;
      system.add({{link, 1}, {link + 1, -1}}, {}, int(i));
    }
    system.add({{links / 2, 1}}, inverse("V"), int(links));
    const auto start = std::chrono::steady_clock::now();
    system.solve();
    EXPECT_EQ(system.value(0), unit("V"));
    EXPECT_EQ(system.value(links), unit("V"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));  // minutes if quadratic
  }
}

}  // namespace
}  // namespace loopwright::unit_system_test
