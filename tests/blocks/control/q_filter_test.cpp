#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::q_filter_test {
namespace {

constexpr double T = 0.001, cutoff = 2 * pi * 40;
std::string settings(int degree) {
  return R"({"cutoff": )" + std::to_string(cutoff) + R"(, "relative_degree": )" + std::to_string(degree) +
         "}";
}

TEST(QFilter, IsTheTustinImageOfEqualLags) {
  const double w0 = std::stod(std::to_string(cutoff));
  for (int n = 1; n <= 4; ++n) {
    BlockUnderTest block("QFilter", settings(n), T);
    for (double w : {0.0, 100.0, 1500.0})
      EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", w, T, 2000),
                          std::pow(w0 / (tustin(w, T) + w0), n), 1e-12);
  }
}

TEST(QFilter, PassesAConstantWithoutChangingABit) {
  for (int n = 1; n <= 4; ++n) {
    BlockUnderTest block(
        "QFilter", R"({"cutoff": 217.3, "initial": 0.1, "relative_degree": )" + std::to_string(n) + "}", T);
    for (int k = 0; k < 1000; ++k) ASSERT_EQ(block.sample("u", 0.1, "y"), 0.1);
  }
}

TEST(QFilter, ReachesAConstantFromZero) {
  BlockUnderTest block("QFilter", settings(4), T);
  for (int k = 0; k < 2000; ++k) block.sample("u", 0.1, "y");
  EXPECT_NEAR(block.output("y"), 0.1, 1e-15);
}

TEST(QFilter, RefusesDegreeFive) {
  EXPECT_THAT(BlockUnderTest("QFilter", settings(5), T).problems().text(), testing::HasSubstr("at most 4"));
}

}  // namespace
}  // namespace loopwright::q_filter_test
