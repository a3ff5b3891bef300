// Sample times become exact ratios of one tick. Blocks run as often as the signals that they read.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::rates_test {
namespace {

const Plan::Block& block(const Plan& plan, std::string_view path) {
  for (const Plan::Block& b : plan.blocks)
    if (b.path == path) return b;
  throw std::invalid_argument("no block " + std::string(path));
}

/// The rate of the first output of a block.
Rate rate(const Plan& plan, std::string_view path) {
  for (const Plan::Entry& entry : plan.order)
    if (entry.kind == Plan::Entry::Kind::outputs && plan.blocks[size_t(entry.block)].path == path)
      return entry.rate;
  throw std::invalid_argument("no outputs of " + std::string(path));
}

std::string hold(std::string_view name, std::string_view time, std::string_view source = "c.time") {
  return fmt::format(R"("{}": {{"type": "ZeroOrderHold", "sample_time": {}, "in": {{"u": "{}"}}}}, )", name,
                     time, source);
}
constexpr std::string_view clock_block = R"("c": {"type": "Clock"})";

TEST(Rates, OneMillisecondAndTwoAndAHalfShareTicksOfAHalf) {
  const auto plan =
      plan_of(diagram(hold("a", "0.001") + hold("b", "0.0025") + std::string(clock_block), R"("stop": 1)"));
  EXPECT_EQ(plan->clock.base, (Fraction{1, 2000}));
  EXPECT_EQ(block(*plan, "a").period, 2);
  EXPECT_EQ(block(*plan, "b").period, 5);
  EXPECT_EQ(plan->stop_tick, 2000);
  EXPECT_EQ(plan->rates.size(), 2u);
}

TEST(Rates, AThreeThousandthIsExact) {
  for (const char* third : {"\"=1/3000\"", "0.000333333333333333333"}) {
    const auto plan =
        plan_of(diagram(hold("a", third) + hold("b", "0.001") + std::string(clock_block), R"("stop": 1)"));
    EXPECT_EQ(plan->clock.base, (Fraction{1, 3000})) << third;
    EXPECT_EQ(block(*plan, "b").period, 3);
    EXPECT_EQ(plan->stop_tick, 3000);
  }
}

TEST(Rates, TenMillionthsPerSecondAndAMillisecondFit) {
  const auto plan = plan_of(diagram(hold("a", "1e-7") + hold("b", "0.001") + std::string(clock_block),
                                    R"("stop": 0.01, "record_step": 0.001, "step": 0.001)"));
  EXPECT_EQ(block(*plan, "b").period, 10000);
}

TEST(Rates, ASecondRateSamplesWhenItIsDueAndHoldsInBetween) {
  const RunResult result = run_of(diagram(hold("a", "0.2") + hold("b", "0.3") + std::string(clock_block),
                                          R"("stop": 1.2, "record_step": 0.1, "step": 0.1)"));
  ASSERT_EQ(result.recording.rows(), 13u);
  for (int i = 0; i <= 12; ++i) {
    EXPECT_EQ(signal(result, "a.y")[size_t(i)], double(i / 2 * 2) / 10) << i;
    EXPECT_EQ(signal(result, "b.y")[size_t(i)], double(i / 3 * 3) / 10) << i;
  }
}

TEST(Rates, AnOffsetShiftsTheFirstSample) {
  const auto plan = plan_of(diagram(
      R"("a": {"type": "ZeroOrderHold", "sample_time": 0.2, "sample_offset": 0.1, "in": {"u": "c.time"}}, "c": {"type": "Clock"})",
      R"("stop": 1, "record_step": 0.1, "step": 0.1)"));
  EXPECT_EQ(block(*plan, "a").offset, 1);
  const RunResult result = simulate(*plan);
  EXPECT_EQ(signal(result, "a.y")[0], 0) << "nothing sampled yet";
  for (int i = 1; i <= 10; ++i)
    EXPECT_EQ(signal(result, "a.y")[size_t(i)], double((i - 1) / 2 * 2 + 1) / 10) << i;
}

TEST(Rates, ABlockWithoutATimeOfItsOwnRunsAsOftenAsWhatItReads) {
  const auto plan = plan_of(diagram(hold("a", "0.2") + hold("b", "0.3") + std::string(clock_block) + R"(,
    "one": {"type": "Constant", "value": {"value": 1, "unit": "s"}}, "g0": {"type": "Gain", "gain": 1, "in": {"u": "one.y"}},
    "ga": {"type": "Gain", "gain": 1, "in": {"u": "a.y"}}, "both": {"type": "Sum", "in": {"terms": ["a.y", "b.y"]}},
    "gc": {"type": "Gain", "gain": 1, "in": {"u": "c.time"}}, "mixed": {"type": "Sum", "in": {"terms": ["a.y", "c.time", "one.y"]}})",
                                    R"("stop": 1.2, "step": 0.1)"));
  using Kind = Rate::Kind;
  EXPECT_EQ(plan->clock.base, (Fraction{1, 10}));
  EXPECT_EQ(rate(*plan, "g0").kind, Kind::constant);
  EXPECT_EQ(rate(*plan, "ga"), (Rate{Kind::sampled, 2, 0}));
  EXPECT_EQ(rate(*plan, "both"), (Rate{Kind::sampled, 1, 0}))
      << "the greatest common divisor of two and three ticks";
  EXPECT_EQ(rate(*plan, "gc").kind, Kind::continuous);
  EXPECT_EQ(rate(*plan, "mixed").kind, Kind::continuous);
}

TEST(Rates, JoinedRatesWithOffsetsMeetEverySampleOfBoth) {
  const std::string blocks =
      R"("a": {"type": "ZeroOrderHold", "sample_time": 0.4, "sample_offset": 0.1, "in": {"u": "c.time"}},
    "b": {"type": "ZeroOrderHold", "sample_time": 0.4, "sample_offset": 0.3, "in": {"u": "c.time"}}, "c": {"type": "Clock"},
    "sum": {"type": "Sum", "in": {"terms": ["a.y", "b.y"]}})";
  const auto plan = plan_of(diagram(blocks, R"("stop": 2, "step": 0.1)"));
  EXPECT_EQ(rate(*plan, "sum"), (Rate{Rate::Kind::sampled, 2, 1}));
  const RunResult result = simulate(*plan);
  for (size_t i = 1; i < result.recording.rows(); ++i)
    EXPECT_EQ(signal(result, "sum.sum")[i], signal(result, "a.y")[i] + signal(result, "b.y")[i]) << i;
}

TEST(Rates, AStopThatIsNoMultipleOfTheTickIsStillReachedExactly) {
  const RunResult result =
      run_of(diagram(hold("a", "0.3") + std::string(clock_block), R"("stop": 1, "step": 0.1)"));
  EXPECT_EQ(result.time, 1.0);
  EXPECT_EQ(signal(result, "time").back(), 1.0);
}

TEST(Rates, SampleTimesAreAskedForWhereTheyAreNeededAndRefusedWhereTheyMakeNoSense) {
  const auto text = [](std::string_view block) {
    return problems_of(diagram(
        fmt::format(R"("x": {{{}, "in": {{"u": "c.y"}}}}, "c": {{"type": "Constant", "value": 1}})", block)));
  };
  EXPECT_TRUE(has(text(R"("type": "UnitDelay")"), "\"sample_time\": seconds"))
      << text(R"("type": "UnitDelay")");
  EXPECT_TRUE(has(text(R"("type": "LowPass", "cutoff": 1, "sample_time": 0.1)"),
                  "LowPass is continuous: it takes no sample time"));
  EXPECT_TRUE(has(text(R"("type": "Gain", "gain": 1, "sample_offset": 0.1)"),
                  "a sample offset without a sample time"));
  EXPECT_TRUE(has(text(R"("type": "Gain", "gain": 1, "sample_time": 0.1, "sample_offset": 0.1)"),
                  "the sample offset is not shorter than the sample time"));
  EXPECT_TRUE(
      has(text(R"("type": "Gain", "gain": 1, "sample_time": 0)"), "expected: a number above 0, in s"));
  EXPECT_TRUE(
      has(text(R"("type": "Gain", "gain": 1, "sample_time": -1)"), "expected: a number above 0, in s"));
  EXPECT_EQ(text(R"("type": "Gain", "gain": 1, "sample_time": 0.1)"), "")
      << "an algebraic block may be sampled";
}

TEST(Rates, TimesWithoutACommonTickAreAnErrorThatShowsThem) {
  const std::string text = problems_of(
      diagram(hold("a", "0.12345678912") + hold("b", "0.10000000123") + std::string(clock_block)));
  EXPECT_TRUE(has(text, "have no common base period") && has(text, "0.12345678912 s and 0.10000000123 s"))
      << text;
  EXPECT_TRUE(has(text, "choose times with a simple ratio")) << text;
}

/// A record that begins at seven of its sample times, as decimals have it.
TEST(Rates, AStartBesideATickIsOnIt) {
  const auto plan = plan_of(diagram(
      std::string(clock_block),
      R"("method": "rk4", "step": 0.0003, "start": 0.004666662, "record_step": 0.000666666, "stop": 0.04)"));
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->clock.time(plan->start_tick), 0.004666662, 1e-9 * 0.0003);
  EXPECT_NEAR(plan->clock.time(plan->record_ticks), 0.000666666, 1e-15);
}

TEST(Rates, MoreTicksThanCanBeCountedAreAnError) {
  const std::string text = problems_of(diagram(hold("a", "1e-9") + std::string(clock_block),
                                               R"("stop": 1e9, "step": 1000, "record_step": 1e6)"));
  EXPECT_TRUE(has(text, "more than can be counted exactly")) << text;
  EXPECT_TRUE(has(text, "top.json:1:")) << text;
}

TEST(Rates, MoreThanSixtyRatesAreAnErrorNotAWrap) {
  std::string blocks(clock_block);
  for (int i = 1; i <= 61; ++i)
    blocks += ", " + hold(fmt::format("h{}", i), fmt::format("\"={}/1000\"", i))
                         .substr(0, hold(fmt::format("h{}", i), fmt::format("\"={}/1000\"", i)).size() - 2);
  EXPECT_TRUE(has(problems_of(diagram(blocks)), "at most 60"));
}

TEST(Rates, SettingsOfTheOtherKindOfSolverAreRefused) {
  EXPECT_TRUE(has(problems_of(diagram("", R"("stop": 1, "relative_tolerance": 1e-6)")),
                  "\"relative_tolerance\" has no meaning for the method \"rk4\""));
  EXPECT_TRUE(has(problems_of(diagram("", R"("stop": 1, "method": "dopri5", "step": 0.1)")),
                  "\"step\" has no meaning for the method \"dopri5\""));
  EXPECT_TRUE(has(problems_of(diagram("", R"("stop": 1, "method": "dopri")")), "did you mean \"dopri5\"?"));
  EXPECT_TRUE(has(problems_of(diagram("", "")), "does not say when to stop"));
  EXPECT_TRUE(
      has(problems_of(diagram("", R"("stop": 1, "start": 2)")), "the stop time lies before the start"));
}

}  // namespace
}  // namespace loopwright::rates_test
