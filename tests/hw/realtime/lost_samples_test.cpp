// Lost samples: model time is that of the device, the plan stays synchronous, and too many in a row end the
// run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "engine/record/recording_file.h"
#include "hw/realtime/period.h"
#include "tests/hw/deployment.h"
#include "where.h"

namespace loopwright::hw::lost_samples_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A buffer that drops its oldest sample and counts the dropped ones, in virtual time.
std::string dropping(const std::string& policy = "{}") {
  return R"({"clock": {"buffer": 2, "overflow": "overwrite", "time": "simulated"}, "policy": )" + policy +
         "}";
}

/// The emulated card loses one sample in a hundred, and reports it by its count of overflows.
class LossyCard : public EmulatedCard {
 public:
  explicit LossyCard(double every = 100, double length = 1) {
    set("lose.every", every), set("lose.length", length), set("lose.told", 1);
  }
};

/// The value of a column at every instant, NaN if the log has no row.
std::vector<double> by_instant(const Recording& recording, const std::string& name) {
  std::vector<double> values(3101, std::nan(""));
  const auto& time = column(recording, "time");
  for (size_t row = 0; row < time.size(); ++row)
    values.at(size_t(std::llround(1e3 * time[row]))) = column(recording, name)[row];
  return values;
}

/// The largest difference at instants that both logs contain.
double largest_difference(const Recording& a, const Recording& b, const std::string& name) {
  const auto x = by_instant(a, name), y = by_instant(b, name);
  double largest = 0;
  for (size_t i = 0; i < x.size(); ++i)
    if (!std::isnan(x[i]) && !std::isnan(y[i])) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (double v : values) most = std::max(most, std::abs(v));
  return most;
}

DeployResult undisturbed() {
  EmulatedCard card;
  return Deployed(dropping()).run();
}

TEST(LostSamples, TheReferenceAndTheLogKeepTheDevicesTime) {
  const DeployResult whole = undisturbed();
  LossyCard card;
  const DeployResult result = Deployed(dropping()).run();
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.lost_samples, 31);
  EXPECT_EQ(result.statistics.longest_gap, 1);
  EXPECT_EQ(result.statistics.cycles, 3101 - 31);
  const auto &time = column(result.recording, "time"), &lost = column(result.recording, "loop.lost");
  int64_t instant = 0;
  for (size_t row = 0; row < time.size(); ++row) {
    instant += row > 0 ? int64_t(lost[row]) + 1 : 0;
    EXPECT_EQ(time[row], double(instant) / 1000) << "a gap in the rows is what loop.lost says";
  }
  EXPECT_EQ(time.back(), 3.1);
  EXPECT_NEAR(card.get("time"), 3.102, 1e-9) << "the card's own time since its first sample";
  EXPECT_EQ(largest_difference(result.recording, whole.recording, "reference.position"), 0);
  EXPECT_EQ(largest_difference(result.recording, whole.recording, "reference.velocity"), 0);
}

TEST(LostSamples, TheStageFollowsAsWithAllItsSamples) {
  const DeployResult whole = undisturbed();
  for (const auto& [every, length] : {std::pair{100.0, 1.0}, {50.0, 2.0}}) {
    const LossyCard card(every, length);
    const DeployResult result = Deployed(dropping()).run();
    ASSERT_EQ(result.status, RunStatus::finished) << result.message;
    EXPECT_NEAR(column(result.recording, "stage.position").back(), 0.6, 1e-4);
    EXPECT_LT(largest_difference(result.recording, whole.recording, "stage.position"), 1e-5) << length;
    EXPECT_LT(largest(column(result.recording, "error.sum")),
              largest(column(whole.recording, "error.sum")) + 1e-5);
  }
}

TEST(LostSamples, InterpolatedMeasurementsSpareTheDifferencesTheirSpikesAndHeldOnesDoNot) {
  const DeployResult whole = undisturbed();
  const LossyCard card(100, 2);
  const DeployResult bridged = Deployed(dropping()).run();
  card.set("reset", 0), card.set("lose.every", 100), card.set("lose.length", 2), card.set("lose.told", 1);
  const DeployResult held = Deployed(dropping(R"({"on_lost": "hold"})")).run();
  ASSERT_EQ(bridged.status, RunStatus::finished) << bridged.message;
  ASSERT_EQ(held.status, RunStatus::finished) << held.message;
  const auto spike = [&](const DeployResult& result) {
    return largest_difference(result.recording, whole.recording, "controller.command");
  };
  EXPECT_LT(spike(bridged), 0.5);
  EXPECT_GT(spike(held), 4 * spike(bridged));
}

TEST(LostSamples, ReplayReproducesTheLogInEveryBit) {
  for (const char* policy : {"{}", R"({"on_lost": "hold"})", R"({"on_lost": "count"})"}) {
    const LossyCard card(70, 2);
    Deployed deployed(dropping(policy));
    const DeployResult result = deployed.run();
    ASSERT_EQ(result.status, RunStatus::finished) << result.message;
    PeriodStepper stepper(*deployed.plan, deployed.hardware);
    const auto& lost = column(result.recording, "loop.lost");
    for (size_t row = 0; row < lost.size(); ++row) {
      stepper.measure(0, column(result.recording, "stage.position")[row], 0);
      stepper.compute(int64_t(lost[row]), [](int) {});
      ASSERT_EQ(stepper.run().now().time, column(result.recording, "time")[row]);
      ASSERT_EQ(stepper.command(0), column(result.recording, "stage.command")[row]) << policy << row;
      stepper.finish();
    }
  }
}

/// Loses this number of samples in a row, once, in the middle of the motion.
DeployResult gap_of(int samples, const std::string& policy) {
  EmulatedCard card;
  card.set("lose.told", 1), card.set("lose.from", 500), card.set("lose.count", samples);
  const DeployResult result = Deployed(R"({"watchdog": {"timeout": 0}, )" + dropping(policy).substr(1)).run();
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(card.get("dac.0"), 0);
  return result;
}

TEST(LostSamples, SoManyInARowAreAFault) {
  for (const char* policy : {"{}", R"({"on_lost": "hold"})"}) {
    EXPECT_EQ(gap_of(2, policy).status, RunStatus::finished);
    const DeployResult result = gap_of(3, policy);
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_EQ(result.fault.code, Code::lost);
    EXPECT_THAT(result.message, AllOf(HasSubstr("the device lost 3 samples in a row at t = "),
                                      HasSubstr("3 end a run (\"on_lost\", \"most_lost\"")));
    EXPECT_EQ(result.recording.rows(), 499u) << "what was measured is kept";
  }
  EXPECT_EQ(gap_of(1, R"({"most_lost": 1})").status, RunStatus::failed);
  EXPECT_EQ(gap_of(9, R"({"most_lost": 10})").status, RunStatus::finished);
}

TEST(LostSamples, WhatIsOnlyCountedHasABoundToo) {
  const DeployResult result = gap_of(30, R"({"on_lost": "count"})");
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.longest_gap, 30);
  EXPECT_EQ(column(result.recording, "time").back(), 3.1);
  const DeployResult beyond = gap_of(1000, R"({"on_lost": "count"})");
  EXPECT_EQ(beyond.status, RunStatus::failed);
  EXPECT_THAT(beyond.message, HasSubstr("lost 1000 samples in a row"));
}

TEST(LostSamples, AStopAmongThemEndsTheRun) {
  EmulatedCard card;
  card.set("lose.told", 1), card.set("lose.from", 3100), card.set("lose.count", 2);
  const DeployResult result = Deployed(dropping()).run();
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(column(result.recording, "time").back(), 3.098) << "samples 3099 and 3100 never came";
}

TEST(LostSamples, CountersAndSlowerRatesKeepTheirPhase) {
  DiagramFolder folder;
  folder.with("device.json", device_text(dropping()));
  folder.with("top.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.001}, "blocks": {
      "one":   {"type": "Constant", "value": 1},
      "next":  {"type": "Sum", "signs": "++", "in": {"terms": ["one.y", "count.y"]}},
      "count": {"type": "UnitDelay", "sample_time": 0.001, "in": {"u": "next.sum"}},
      "ramp":  {"type": "Ramp", "slope": 1},
      "slow":  {"type": "UnitDelay", "sample_time": 0.007, "in": {"u": "ramp.y"}},
      "zero":  {"type": "Constant", "value": {"value": 0, "unit": "V"}},
      "stage": {"variants": {"quanser": {"type": "HardwareIo", "device": "device.json", "sample_time": 0.001}},
                "in": {"command": "zero.y"}}}, "log": ["count.y", "slow.y"]})");
  const LossyCard card(9, 2);
  const DeployResult result = Deployed(dropping(), {}, folder.path("top.json")).run();
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_GT(result.statistics.lost_samples, 200);
  const auto& time = column(result.recording, "time");
  for (size_t row = 0; row < time.size(); ++row) {
    const int64_t instant = std::llround(1e3 * time[row]);
    EXPECT_EQ(column(result.recording, "count.y")[row], double(instant));
    EXPECT_NEAR(column(result.recording, "slow.y")[row],
                0.007 * double(std::max<int64_t>(0, instant / 7 - 1)), 1e-12);
  }
}

// ---- periods that the computer's clock skips ----

/// Wakes up late once.
class SleepyClock final : public Clock {
 public:
  SleepyClock(int64_t at_ns, int64_t late_ns) : at_(at_ns), late_(late_ns) {}
  int64_t now_ns() noexcept override { return now_; }
  void sleep_until(int64_t ns) noexcept override {
    now_ = ns + (ns >= at_ ? late_ : 0);
    if (ns >= at_) late_ = 0;
  }

 private:
  int64_t now_ = 0, at_, late_;
};

DeployResult oversleeping(double periods, const std::string& policy) {
  EmulatedCard card;
  Deployed deployed(R"({"clock": {"source": "host"}, "watchdog": {"timeout": 0}, "policy": )" + policy + "}");
  SleepyClock clock(500'000'000, int64_t(1e6 * periods));
  DeployOptions options;
  options.clock = &clock;
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  return result;
}

TEST(SkippedPeriods, AreCountedAndTheModelKeepsTime) {
  const DeployResult result = oversleeping(5.3, "{}");
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.skipped_periods, 5);
  EXPECT_EQ(result.statistics.longest_gap, 5);
  EXPECT_EQ(result.statistics.lost_samples, 0);
  EXPECT_EQ(result.statistics.cycles, 3101 - 5);
  EXPECT_EQ(1e-6 * double(result.statistics.lateness.longest_ns()), 5.3);
  const auto& time = column(result.recording, "time");
  EXPECT_EQ(time[499], 0.499);
  EXPECT_EQ(time[500], 0.505) << "the sample was taken then";
  EXPECT_EQ(column(result.recording, "loop.lost")[500], 5);
  EXPECT_EQ(time.back(), 3.1);
}

TEST(SkippedPeriods, SoManyInARowAreAFault) {
  EXPECT_EQ(oversleeping(19.9, "{}").status, RunStatus::finished);
  const DeployResult result = oversleeping(20.1, "{}");
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message,
              AllOf(HasSubstr("left out 20 periods in a row"), HasSubstr("\"most_skipped\"")));
  EXPECT_EQ(oversleeping(3.1, R"({"most_skipped": 3})").status, RunStatus::failed);
}

// ---- impossible readings in the first sample ----

TEST(FirstSample, NoNumberInItNeverStartsAMotion) {
  for (const double bad : {std::nan(""), HUGE_VAL, 1e6}) {
    EmulatedCard card;
    card.set("plant.cogging", 0), card.set("plant.cogging_2", 0);
    card.set("analog.bad_from", 0), card.set("analog.bad_volts", bad);
    Deployed deployed(R"({"clock": {"time": "simulated"}, "policy": {"on_invalid": "hold"},
        "inputs": {"current": {"kind": "analog", "channel": 0, "unit": "A", "scale": 1}}})");
    const DeployResult result = deployed.run();
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_THAT(result.message, AllOf(HasSubstr("input \"current\" (analog 0) read "),
                                      HasSubstr("the diagram has not begun")));
    EXPECT_EQ(result.statistics.cycles, 0);
    EXPECT_EQ(card.get("plant.position"), 0);
    EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  }
}

TEST(FirstSample, AGlitchInItNeverStartsAMotion) {
  const DeployResult whole = undisturbed();
  EmulatedCard card;
  card.set("glitch.at", 1), card.set("glitch.count", 1), card.set("glitch.counts", 2e6);
  const DeployResult result = Deployed(in_virtual_time).run();
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_LT(std::abs(column(result.recording, "stage.position").front()), 1e-4) << "the glitch is 0.4 m";
  EXPECT_LT(largest(column(result.recording, "error.sum")),
            largest(column(whole.recording, "error.sum")) + 1e-5);
}

TEST(BadReading, OneInTheMotionIsAFaultOrHeldAsThePolicySays) {
  const auto bad_for = [](int samples, const std::string& policy) {
    EmulatedCard card;
    card.set("analog.bad_from", 700), card.set("analog.bad_count", samples),
        card.set("analog.bad_volts", std::nan(""));
    const DeployResult result = Deployed(R"({"clock": {"time": "simulated"}, "policy": )" + policy + R"(,
        "inputs": {"current": {"kind": "analog", "channel": 0, "unit": "A", "scale": 1}}})")
                                    .run();
    EXPECT_EQ(card.get("dac.0"), 0);
    EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
    return result;
  };
  const DeployResult fault = bad_for(1, "{}");
  EXPECT_EQ(fault.status, RunStatus::failed);
  EXPECT_EQ(fault.message, "input \"current\" (analog 0) read nan V, which is not finite, at t = 0.699 s");
  EXPECT_EQ(bad_for(2, R"({"on_invalid": "hold"})").status, RunStatus::finished);
  EXPECT_EQ(bad_for(3, R"({"on_invalid": "hold"})").status, RunStatus::failed);
}

}  // namespace
}  // namespace loopwright::hw::lost_samples_test
