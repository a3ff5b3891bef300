#include <gmock/gmock.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::kalman_test {
namespace {

using testing::HasSubstr;

/// A random walk with noise of the variances q and r.
std::string walk(const std::string& more, double q = 0.3, double r = 2) {
  return R"({"states": [{"name": "x"}], "measurements": [{"name": "y"}], "A": [[1]], "C": [[1]], "Q": [[)" +
         std::to_string(q) + "]], \"R\": [[" + std::to_string(r) + "]]" + more + "}";
}

TEST(Kalman, TheSteadyGainOfARandomWalkHasItsClosedForm) {
  BlockUnderTest filter("Kalman", walk(R"(, "initial": [1])"), 0.1);
  ASSERT_FALSE(filter.problems().has_errors()) << filter.problems().text();
  const double q = 0.3, r = 2, P = 0.5 * (q + std::sqrt(q * q + 4 * q * r)), M = P / (P + r);
  double x = 1;
  for (int k = 0; k < 20; ++k) {
    filter.input("y") = std::cos(k);
    filter.evaluate();
    x += M * (std::cos(k) - x);
    EXPECT_NEAR(filter.output("x"), x, 1e-13);
    filter.update();
  }
}

TEST(Kalman, WithoutNoiseOfTheStateTheVaryingFilterIsTheMeanOfAllMeasurements) {
  BlockUnderTest filter("Kalman", walk(R"(, "gain": "time_varying", "initial_covariance": [[1e12]])", 0, 1),
                        0.1);
  ASSERT_FALSE(filter.problems().has_errors()) << filter.problems().text();
  double sum = 0;
  for (int k = 0; k < 50; ++k) {
    filter.input("y") = std::sin(3.0 * k);
    sum += std::sin(3.0 * k);
    filter.evaluate();
    EXPECT_NEAR(filter.output("x"), sum / (k + 1), 1e-9);
    filter.update();
  }
}

TEST(Kalman, MoreMeasurementsThanStatesAreWeighedByTheirVariances) {
  BlockUnderTest filter(
      "Kalman", R"({"states": [{"name": "x"}], "measurements": [{"name": "a"}, {"name": "b"}, {"name": "c"}],
      "A": [[1]], "C": [[1], [1], [2]], "Q": [[0]], "R": [[1, 0, 0], [0, 4, 0], [0, 0, 16]],
      "gain": "time_varying", "initial_covariance": [[1e12]]})",
      0.1);
  ASSERT_FALSE(filter.problems().has_errors()) << filter.problems().text();
  filter.input("a") = 1, filter.input("b") = 2, filter.input("c") = 6;
  for (int k = 0; k < 5; ++k) filter.evaluate(), filter.update();
  filter.evaluate();
  EXPECT_NEAR(filter.output("x"), (1 + 2 / 4.0 + 3 / 4.0) / (1 + 1 / 4.0 + 1 / 4.0), 1e-9);
}

TEST(Kalman, AKnownInputMovesThePredictionNotTheOutput) {
  BlockUnderTest filter("Kalman", walk(R"(, "B": [[2]])"), 0.1);
  filter.inputs("inputs") = {0};
  filter.evaluate();
  const double before = filter.output("x");
  filter.inputs("inputs") = {5};
  filter.evaluate();
  EXPECT_EQ(filter.output("x"), before);
  filter.update();
  filter.input("y") = 10;
  filter.evaluate();
  EXPECT_NEAR(filter.output("x"), 10, 1e-12);
}

TEST(Kalman, RefusesWhatDoesNotFit) {
  const auto text = [](const std::string& settings) {
    return BlockUnderTest("Kalman", settings, 0.1).problems().text();
  };
  EXPECT_THAT(
      text(
          R"({"states": [{"name": "x"}, {"name": "v"}], "measurements": [{"name": "y"}], "A": [[1, 0]], "C": [[1]],
      "Q": [[1, 0], [0.5, 1]], "R": [[-1]]})"),
      testing::AllOf(HasSubstr("2 rows of 2"), HasSubstr("symmetric"), HasSubstr("negative")));
  EXPECT_THAT(text(walk(R"(, "initial_covariance": [[1]])")), HasSubstr("time_varying"));
  EXPECT_THAT(text(walk(R"(, "gain": "time_varying")")), HasSubstr("1 rows of 1 numbers: a covariance"));
  EXPECT_THAT(
      text(
          R"({"states": [{"name": "x"}], "measurements": [{"name": "inputs", "unit": "furlogn"}], "A": [[1]], "C": [[1]],
      "Q": [[1]], "R": [[1]]})"),
      testing::AllOf(HasSubstr("already in use"), HasSubstr("no such unit")));
}

}  // namespace
}  // namespace loopwright::kalman_test
