#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::nominal_inverse_test {
namespace {

constexpr double T = 0.001;
std::string settings(int degree) {
  return R"({"mass": 0.2621, "damping": 3, "cutoff": 250, "relative_degree": )" + std::to_string(degree) +
         "}";
}

TEST(NominalInverse, IsTheTustinImageOfItsFormula) {
  for (int n : {2, 3}) {
    BlockUnderTest block("NominalInverse", settings(n), T);
    for (double w : {0.0, 20.0, 300.0, 2000.0}) {
      const Complex s = tustin(w, T),
                    expected = std::pow(250.0 / (s + 250.0), n) * (0.2621 * s * s + 3.0 * s);
      EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "command", w, T, 2000), expected, 1e-7);
    }
  }
}

TEST(NominalInverse, OfASteadyMotionIsItsFriction) {
  for (int n : {2, 3}) {
    BlockUnderTest block("NominalInverse", settings(n), T);
    for (int k = 0; k < 2000; ++k) block.sample("measured", 0.4 * T * k, "command");
    EXPECT_NEAR(block.output("command"), 3 * 0.4, 1e-8);  // positions of 0.8 m, rounded, divided twice by T
  }
}

TEST(NominalInverse, AtRestAtItsInitialPositionGivesNothing) {
  BlockUnderTest block("NominalInverse", R"({"mass": 1, "damping": 3, "cutoff": 250, "initial": 0.3})", T);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(block.sample("measured", 0.3, "command"), 0);
}

}  // namespace
}  // namespace loopwright::nominal_inverse_test
