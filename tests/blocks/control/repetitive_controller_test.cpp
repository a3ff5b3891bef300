#include <gmock/gmock.h>
#include <cmath>
#include <deque>
#include "tests/blocks/block_under_test.h"

namespace loopwright::repetitive_controller_test {
namespace {

TEST(RepetitiveController, FollowsItsDifferenceEquation) {
  constexpr int N = 12, lead = 3;
  BlockUnderTest block("RepetitiveController", R"({"period": 12, "lead": 3, "gain": 0.7, "smoothing": 0.1})",
                       0.001);
  ASSERT_FALSE(block.problems().has_errors()) << block.problems().text();
  block.input("enable") = 1;
  std::vector<double> r, e;
  const auto at = [](const std::vector<double>& list, int k) { return k < 0 ? 0.0 : list[size_t(k)]; };
  for (int k = 0; k < 100; ++k) {
    r.push_back(0.1 * (at(r, k - N + 1) + at(r, k - N - 1)) + 0.8 * at(r, k - N) + 0.7 * at(e, k - N + lead));
    e.push_back(std::sin(0.9 * k));
    block.input("error") = e.back();
    block.evaluate();
    EXPECT_NEAR(block.output("correction"), r.back(), 1e-13) << k;
    block.update();
  }
}

TEST(RepetitiveController, LearnsAwayAPeriodicDisturbance) {
  // A loop that answers two samples later, with a part in the next: -e = d + S r, S = 0.8 z⁻² + 0.2 z⁻³.
  BlockUnderTest block("RepetitiveController", R"({"period": 50, "lead": 2, "gain": 0.6, "smoothing": 0})",
                       0.001);
  block.input("enable") = 1;
  std::deque<double> r(4, 0.0);
  double first = 0, last = 0;
  for (int k = 0; k < 50 * 60; ++k) {
    const double d = std::sin(2 * pi * k / 50) + 0.3 * std::sin(6 * pi * k / 50 + 1);
    const double error = d - 0.8 * r[1] - 0.2 * r[2];
    (k < 50 ? first : last) = std::max(k < 50 ? first : (k % 50 == 0 ? 0 : last), std::abs(error));
    block.input("error") = error;
    block.evaluate();
    r.push_front(block.output("correction"));
    block.update();
  }
  EXPECT_GT(first, 0.9);
  EXPECT_LT(last, 1e-9);
}

TEST(RepetitiveController, KeepsWhatItHasLearnedWhileItIsDisabled) {
  BlockUnderTest block("RepetitiveController", R"({"period": 3, "gain": 1, "smoothing": 0})", 0.001);
  block.input("enable") = 1;
  for (int k = 0; k < 3; ++k) block.input("error") = k + 1, block.evaluate(), block.update();
  block.input("enable") = 0, block.input("error") = 100;
  for (int k = 0; k < 5; ++k) {
    block.evaluate();
    EXPECT_EQ(block.output("correction"), 0);
    block.update();
  }
  block.input("enable") = 1, block.input("error") = 0;
  for (int k = 0; k < 6; ++k) {
    block.evaluate();
    EXPECT_EQ(block.output("correction"), k % 3 + 1);
    block.update();
  }
}

TEST(RepetitiveController, RefusesALeadOfAPeriod) {
  EXPECT_THAT(BlockUnderTest("RepetitiveController", R"({"period": 3, "lead": 3, "gain": 1})", 0.001)
                  .problems()
                  .text(),
              testing::HasSubstr("less than 3"));
}

}  // namespace
}  // namespace loopwright::repetitive_controller_test
