#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::transfer_function_test {
namespace {

Complex ratio(std::vector<double> numerator, std::vector<double> denominator, Complex s) {
  Complex b = 0, a = 0;
  for (double c : numerator) b = b * s + c;
  for (double c : denominator) a = a * s + c;
  return b / a;
}

TEST(TransferFunction, AnswersEveryFrequencyAsItsPolynomialsSay) {
  BlockUnderTest block("TransferFunction", R"({"numerator": [2, 30, 400], "denominator": [0.5, 8, 90]})");
  for (double w : {0.0, 1.0, 13.0, 40.0, 1e4})
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w), ratio({2, 30, 400}, {0.5, 8, 90}, {0, w}),
                        1e-12);
}

TEST(TransferFunction, TakesANumeratorOfLowerDegree) {
  BlockUnderTest block("TransferFunction", R"({"numerator": [5], "denominator": [1, 6, 11, 6]})");
  for (double w : {0.0, 0.7, 20.0})
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w), ratio({5}, {1, 6, 11, 6}, {0, w}), 1e-14);
}

TEST(TransferFunction, FollowsTheClosedFormOfALeadsStep) {
  BlockUnderTest block("TransferFunction", R"({"numerator": [1, 2], "denominator": [1, 10]})");
  block.input("u") = 1;
  block.evaluate();
  EXPECT_EQ(block.output("y"), 1);  // the gain at high frequencies at once
  block.advance(0.3, 1000);
  block.evaluate();
  EXPECT_NEAR(block.output("y"), 0.2 + 0.8 * std::exp(-3.0), 1e-12);
}

TEST(TransferFunction, KeepsItsStatesAsLargeAsTheInputWhateverTheSpeed) {
  BlockUnderTest block("StrictlyProperTransferFunction",
                       R"({"numerator": [1e16], "denominator": [1, 4e4, 6e8, 4e12, 1e16]})");
  block.input("u") = 1;
  block.advance(0.01, 4000);  // a hundred times the time constant
  block.evaluate();
  EXPECT_NEAR(block.output("y"), 1, 1e-12);
  for (double z : block.states()) EXPECT_LT(std::abs(z), 10);
  EXPECT_GT(block.states()[0], 0.1);
}

TEST(TransferFunction, IntegratesWhereTheDenominatorHasZerosAtTheEnd) {
  BlockUnderTest block("StrictlyProperTransferFunction", R"({"numerator": [8], "denominator": [2, 0, 0]})");
  block.input("u") = 1;
  block.advance(3, 30);
  block.evaluate();
  EXPECT_NEAR(block.output("y"), 4 * 9 / 2.0, 1e-12);
}

TEST(TransferFunction, CoefficientsAreTunable) {
  BlockUnderTest block("TransferFunction", R"({"numerator": [1], "denominator": [1, 1]})");
  block.tune("denominator.1", 4);
  EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", 0), 0.25, 1e-15);
}

TEST(TransferFunction, TheStrictlyProperOneNeedsNoPresentInput) {
  BlockUnderTest proper("TransferFunction", R"({"numerator": [1], "denominator": [1, 1]})");
  BlockUnderTest strict("StrictlyProperTransferFunction",
                        R"({"numerator": [3, 1], "denominator": [1, 2, 5]})");
  EXPECT_EQ(proper.info().outputs[0].fed_by, 1u);
  EXPECT_EQ(strict.info().outputs[0].fed_by, 0u);
  for (double w : {0.0, 2.0, 50.0})
    EXPECT_COMPLEX_NEAR(continuous_response(strict, "u", "y", w), ratio({3, 1}, {1, 2, 5}, {0, w}), 1e-14);
}

TEST(TransferFunction, RefusesWhatIsNotProper) {
  EXPECT_THAT(BlockUnderTest("TransferFunction", R"({"numerator": [1, 0, 0], "denominator": [1, 1]})")
                  .problems()
                  .text(),
              testing::HasSubstr("not proper"));
  EXPECT_THAT(
      BlockUnderTest("StrictlyProperTransferFunction", R"({"numerator": [1, 0], "denominator": [1, 1]})")
          .problems()
          .text(),
      testing::HasSubstr("TransferFunction"));
  for (const char* type : {"TransferFunction", "StrictlyProperTransferFunction"}) {
    EXPECT_THAT(BlockUnderTest(type, R"({"numerator": [1], "denominator": [0, 1, 2]})").problems().text(),
                testing::HasSubstr("coefficient zero"));
    EXPECT_THAT(BlockUnderTest(type, R"({"numerator": [], "denominator": []})").problems().list(),
                testing::SizeIs(2));
  }
}

}  // namespace
}  // namespace loopwright::transfer_function_test
