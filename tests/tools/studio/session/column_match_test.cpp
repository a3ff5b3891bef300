// Units at the end of a column's name.
#include "tools/studio/session/column_match.h"
#include <gtest/gtest.h>
#include <cmath>

namespace loopwright::studio {
namespace {

std::string unit_in(const std::string& name) {
  Recording record;
  record.columns = {{"time", "s", {0, 1}}, {name, "", {1, 2}}};
  return guess_columns(record, {}, {}).at(1).unit;
}

TEST(ColumnGuess, AUnitAtTheEndOfANameIsRead) {
  for (const auto& [name, unit] : {std::pair("force_N", "N"),
                                   {"position_mm", "mm"},
                                   {"speed_rpm", "rpm"},
                                   {"x_m", "m"},
                                   {"current_A", "A"},
                                   {"angle_deg", "deg"}})
    EXPECT_EQ(unit_in(name), unit) << name;
}

TEST(ColumnGuess, ALetterThatIsNoUsualUnitBelongsToTheName) {
  for (const char* name : {"i_d", "i_q", "pos_a", "pos_b", "v_u", "v_t", "u_in", "x_min", "q_ref", "x_e"})
    EXPECT_EQ(unit_in(name), "") << name;
}

TEST(ColumnGuess, TheRangeIsThatOfTheNumbers) {
  Recording record;
  record.columns = {{"time", "s", {0, 1, 2}}, {"x", "m", {NAN, 3, -1}}, {"note", "", {NAN, NAN, NAN}}};
  const auto guesses = guess_columns(record, {}, {});
  EXPECT_EQ(guesses.at(1).low, -1);
  EXPECT_EQ(guesses.at(1).high, 3);
  EXPECT_EQ(guesses.at(2).low, 0);
}

}  // namespace
}  // namespace loopwright::studio
