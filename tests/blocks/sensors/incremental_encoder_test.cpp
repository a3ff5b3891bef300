#include <gmock/gmock.h>
#include <cmath>
#include <random>
#include "tests/blocks/block_under_test.h"

namespace loopwright::incremental_encoder_test {
namespace {

double read_at(BlockUnderTest& encoder, double position, double reset = 0, double value = 0) {
  encoder.input("position") = position, encoder.input("reset") = reset, encoder.input("reset_value") = value;
  encoder.evaluate();
  return encoder.output("position");
}

TEST(IncrementalEncoder, KnowsOnlyHowFarItHasMoved) {
  BlockUnderTest encoder("IncrementalEncoder", R"({"resolution": 0.5, "initial": 100})");
  EXPECT_EQ(read_at(encoder, 7.3), 100);  // count 15
  EXPECT_EQ(read_at(encoder, 7.9), 100.5);
  EXPECT_EQ(read_at(encoder, 5.0), 97.5);
}

TEST(IncrementalEncoder, ReadsTheGivenValueWhereItIsReset) {
  // The reference counts edges of a grid of width q, as the hardware does, in whole numbers.
  std::mt19937_64 random(6);
  std::normal_distribution<double> step(0, 0.3);
  BlockUnderTest encoder("IncrementalEncoder", R"({"resolution": 0.25})");
  double position = 3.1, value = 0;
  long long zero = std::llrint(position / 0.25);
  bool last = false;
  for (int k = 0; k < 5000; ++k) {
    const bool reset = random() % 10 == 0;
    const double new_value = double(random() % 10);
    const double found = read_at(encoder, position, reset, new_value);
    const long long count = std::llrint(position / 0.25);
    if (k > 0 && reset && !last) zero = count, value = new_value;
    last = reset;
    ASSERT_EQ(found, value + 0.25 * double(count - zero)) << k;
    position += step(random);
  }
}

TEST(IncrementalEncoder, RezeroesAContinuousPosition) {
  BlockUnderTest encoder("IncrementalEncoder", R"({"resolution": 0})");
  EXPECT_EQ(read_at(encoder, 2.125), 0);
  EXPECT_EQ(read_at(encoder, 3.5), 1.375);
  EXPECT_EQ(read_at(encoder, 3.75, 1, 20), 20);
  EXPECT_EQ(read_at(encoder, 4, 1, 70), 20.25) << "a reset that stays true is no second edge";
}

TEST(IncrementalEncoder, ShowsItsReferenceMarks) {
  BlockUnderTest one("IncrementalEncoder", R"({"resolution": 0.1, "index_position": 2})"),
      many("IncrementalEncoder",
           R"({"resolution": 0.1, "index_position": 2, "index_pitch": 5, "index_width": 0.4})");
  for (const auto& [position, narrow, wide] : {std::tuple(2.0, 1.0, 1.0),
                                               {2.04, 1.0, 1.0},
                                               {2.06, 0.0, 1.0},
                                               {1.81, 0.0, 1.0},
                                               {2.3, 0.0, 0.0},
                                               {7.1, 0.0, 1.0},
                                               {-3.19, 0.0, 1.0},
                                               {4.5, 0.0, 0.0}}) {
    read_at(one, position), read_at(many, position);
    EXPECT_EQ(one.output("index"), narrow) << position;
    EXPECT_EQ(many.output("index"), wide) << position;
  }
}

TEST(IncrementalEncoder, RefusesMarksThatTouch) {
  EXPECT_THAT(
      BlockUnderTest("IncrementalEncoder", R"({"resolution": 1, "index_pitch": 0.5})").problems().text(),
      testing::HasSubstr("touch"));
}

}  // namespace
}  // namespace loopwright::incremental_encoder_test
