#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::derivative_test {
namespace {

TEST(Derivative, AnswersEveryFrequencyAsItsFormulaSays) {
  BlockUnderTest block("Derivative", R"({"cutoff": 50})");
  for (double w : {0.0, 3.0, 50.0, 4000.0})
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w), 50.0 * Complex(0, w) / Complex(50, w),
                        1e-11);
}

TEST(Derivative, OfAJumpIsAPeakThatDecays) {
  BlockUnderTest block("Derivative", R"({"cutoff": 50, "initial": 1})");
  block.input("u") = 1;
  block.evaluate();
  EXPECT_EQ(block.output("y"), 0);
  block.input("u") = 1.2;
  block.evaluate();
  EXPECT_NEAR(block.output("y"), 10, 1e-12);  // a jump gives a peak of cutoff times the step
  block.advance(0.1, 1000);
  block.evaluate();
  EXPECT_NEAR(block.output("y"), 10 * std::exp(-5.0), 1e-9);
}

}  // namespace
}  // namespace loopwright::derivative_test
