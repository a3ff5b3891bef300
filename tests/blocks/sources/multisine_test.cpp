#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::multisine_test {

TEST(Multisine, AddsItsComponents) {
  BlockUnderTest sum("Multisine", R"({"bias": 0.5, "components": [
      {"amplitude": 1, "frequency": 2}, {"amplitude": 0.25, "frequency": 7, "phase": 1.5}]})");
  for (double t = 0; t < 2; t += 0.013) {
    sum.evaluate(t);
    EXPECT_NEAR(sum.output("y"), 0.5 + std::sin(2 * pi * 2 * t) + 0.25 * std::sin(2 * pi * 7 * t + 1.5),
                1e-13)
        << t;
  }
}

TEST(Multisine, SchroederPhasesKeepThePeakOfABandLow) {
  const int n = 64;
  BlockUnderTest band("Multisine", R"({"band": {"from": 1, "to": 64, "count": 64, "amplitude": 1}})");
  double peak = 0, square = 0;
  const int samples = 4096;
  for (int i = 0; i < samples; ++i) {
    band.evaluate(double(i) / samples);
    peak = std::max(peak, std::abs(band.output("y")));
    square += band.output("y") * band.output("y");
  }
  const double rms = std::sqrt(square / samples);
  EXPECT_NEAR(rms, std::sqrt(n / 2.0),
              1e-9);  // Parseval: each component carries half of its amplitude squared
  EXPECT_NEAR(peak / rms, 1.90539,
              1e-5);  // the same sum computed independently; with equal phases 8.26
}

TEST(Multisine, RepeatsAfterTheCommonPeriod) {
  BlockUnderTest band("Multisine", R"({"band": {"from": 0.5, "to": 20, "count": 40, "amplitude": 1}})");
  for (double t : {0.1, 0.77, 1.9}) {
    band.evaluate(t);
    const double y = band.output("y");
    band.evaluate(t + 2);
    EXPECT_NEAR(band.output("y"), y, 1e-11);
  }
}

TEST(Multisine, ItsAmplitudesAreTunable) {
  BlockUnderTest sum("Multisine", R"({"components": [{"amplitude": 1, "frequency": 1}]})");
  sum.tune("components.0.amplitude", 3);
  sum.evaluate(0.25);
  EXPECT_DOUBLE_EQ(sum.output("y"), 3);
}

TEST(Multisine, RefusesToAddNothingAndEmptyBands) {
  EXPECT_NE(BlockUnderTest("Multisine").problems().text().find("nothing to add up"), std::string::npos);
  BlockUnderTest band("Multisine", R"({"band": {"from": 5, "to": 1, "count": 3, "amplitude": 1}})");
  EXPECT_NE(band.problems().text().find("the band is empty"), std::string::npos) << band.problems().text();
}

}  // namespace loopwright::multisine_test
