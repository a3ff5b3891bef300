#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::chirp_test {

namespace {

/// The phase at time t by Simpson's rule over the frequency, rad.
double integrated_phase(auto frequency, double t) {
  const int n = 20000;
  const double h = t / n;
  double sum = frequency(0.0) + frequency(t);
  for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * frequency(i * h);
  return 2 * pi * sum * h / 3;
}

}  // namespace

TEST(Chirp, LinearSweepHasTheIntegratedFrequencyAsPhase) {
  BlockUnderTest chirp("Chirp",
                       R"({"amplitude": 3, "from": 2, "to": 30, "duration": 4, "phase": 0.4, "bias": 1})");
  const auto f = [](double t) { return 2 + 28 * t / 4; };
  for (double t : {0.0, 0.3, 1.7, 3.99}) {
    chirp.evaluate(t);
    EXPECT_NEAR(chirp.output("y"), 1 + 3 * std::sin(integrated_phase(f, t) + 0.4), 1e-10) << t;
    EXPECT_NEAR(chirp.output("frequency"), f(t), 1e-12);
  }
}

TEST(Chirp, LogarithmicSweepHasTheIntegratedFrequencyAsPhase) {
  BlockUnderTest chirp("Chirp", R"({"from": 0.5, "to": 40, "duration": 4, "sweep": "logarithmic"})");
  const auto f = [](double t) { return 0.5 * std::pow(80.0, t / 4); };
  for (double t : {0.0, 0.01, 0.3, 1.7, 3.99}) {
    chirp.evaluate(t);
    EXPECT_NEAR(chirp.output("y"), std::sin(integrated_phase(f, t)), 1e-9) << t;
    EXPECT_NEAR(chirp.output("frequency"), f(t), 1e-12);
  }
}

TEST(Chirp, LogarithmicSweepBetweenNearlyEqualFrequenciesLosesNoDigits) {
  for (const char* last : {"7", "7.0000000001"}) {
    BlockUnderTest chirp(
        "Chirp", R"({"from": 7, "duration": 100, "sweep": "logarithmic", "to": )" + std::string(last) + "}");
    chirp.evaluate(93.21);
    const double growth = std::stod(last) / 7 - 1;
    EXPECT_NEAR(chirp.output("y"), std::sin(2 * pi * 7 * 93.21 * (1 + 0.5 * growth * 0.9321)), 1e-10) << last;
  }
}

TEST(Chirp, RestsBeforeItsStartAndAfterItsEnd) {
  BlockUnderTest chirp("Chirp", R"({"from": 1, "to": 2, "duration": 2, "start": 1, "bias": 5, "phase": 1})");
  for (double t : {0.0, 0.99, 3.0, 9.0}) {
    chirp.evaluate(t);
    EXPECT_EQ(chirp.output("y"), 5) << t;
    EXPECT_EQ(chirp.output("frequency"), 0) << t;
  }
  EXPECT_EQ(chirp.next_stop(0), 1);
  EXPECT_EQ(chirp.next_stop(1), 3);
  EXPECT_EQ(chirp.next_stop(3), infinity);
}

TEST(Chirp, StartsAnewWhenItRepeats) {
  BlockUnderTest chirp("Chirp", R"({"from": 1, "to": 5, "duration": 0.75, "repeats": true})");
  chirp.evaluate(0.2);
  const double first = chirp.output("y");
  chirp.evaluate(0.2 + 4 * 0.75);
  EXPECT_NEAR(chirp.output("y"), first, 1e-12);
  EXPECT_EQ(chirp.next_stop(0.8), 1.5);
}

TEST(Chirp, BeginsEachSweepOnItsVeryTick) {
  BlockUnderTest chirp(
      "Chirp", R"({"from": 100, "to": 200, "duration": 0.007, "repeats": true, "bias": 5, "start": 0.001})");
  for (const int64_t from : {int64_t(0), int64_t(999'990'000)})
    for (int64_t tick = from; tick < from + 10'000; ++tick) {
      chirp.evaluate(double(tick) / 1000, tick);
      const int64_t phase = (tick + 6) % 7;
      const double expected = tick < 1 ? 0 : 100 + 100 * double(phase) / 7;
      ASSERT_NEAR(chirp.output("frequency"), expected, 1e-5) << tick;
      if (tick >= 1 && phase == 0) {
        ASSERT_EQ(chirp.output("frequency"), 100) << tick;
        ASSERT_EQ(chirp.output("y"), 5) << tick;
      }
    }
  EXPECT_EQ(chirp.shortest_period(), 1.0 / 200);
}

TEST(Chirp, RefusesALogarithmicSweepFromZero) {
  BlockUnderTest chirp("Chirp", R"({"from": 0, "to": 5, "duration": 1, "sweep": "logarithmic"})");
  EXPECT_NE(chirp.problems().text().find("cannot reach 0 Hz"), std::string::npos) << chirp.problems().text();
}

}  // namespace loopwright::chirp_test
