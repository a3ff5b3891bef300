#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::logarithm_test {
namespace {

TEST(Logarithm, IsThatOfTheCLibraryInEveryBase) {
  const std::pair<const char*, long double (*)(long double)> bases[] = {
      {"e", logl}, {"2", log2l}, {"10", log10l}};
  for (const auto& [base, reference] : bases) {
    BlockUnderTest block("Logarithm", std::string(R"({"base": ")") + base + "\"}");
    for (double u = 1e-300; u < 1e300; u *= 1.731) {
      block.input("u") = u;
      block.evaluate();
      const double expected = double(reference(u));
      EXPECT_NEAR(block.output("y"), expected, 4e-16 * std::fabs(expected)) << base << " of " << u;
    }
    EXPECT_EQ(block.fault(), "");
  }
  BlockUnderTest decades("Logarithm", R"({"base": "10"})");
  decades.input("u") = 1000;
  decades.evaluate();
  EXPECT_EQ(decades.output("y"), 3);
}

TEST(Logarithm, StopsAtZeroAndBelow) {
  for (const double u : {0.0, -1.0, std::nan("")}) {
    BlockUnderTest block("Logarithm");
    block.input("u") = u;
    block.evaluate();
    EXPECT_EQ(block.fault(), "the logarithm of a number that is not above 0") << u;
  }
}

}  // namespace
}  // namespace loopwright::logarithm_test
