// Calls of the driver that never return: the program ends all the same, and safe values are sent by another
// thread unless the driver lets no call through. Each takes place in a child process (ends_test.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <csignal>
#include <thread>
#include "hw/realtime/detached_call.h"
#include "tests/hw/realtime/ends.h"

namespace loopwright::hw::ends_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Only this program can put out the safe values.
const std::string without_watchdog =
    R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "policy": {"on_overrun": "count", "on_lost": "count"}, "watchdog": null})";

class Hangs : public Ends {
 protected:
  void begin_to_hang(const std::string& how, const std::string& device = without_watchdog,
                     const std::string& end_timeout = "1", const std::string& stop = "") {
    std::filesystem::remove(journal());
    begin("loop", how, stop, device, end_timeout);
    ASSERT_TRUE(wait_until_driven(0.3)) << text("err");
  }
};

TEST_F(Hangs, ALibraryThatHangsWithItsLockHeldIsLeftWithTheOutputsSafe) {
  begin_to_hang("hang in read, request_stop");
  EXPECT_EQ(wait(), 1) << text("err");
  EXPECT_EQ(card_->get("dac.0"), 0);
  EXPECT_THAT(text("err"), AllOf(HasSubstr("the run does not come to its end: safe values were sent"),
                                 HasSubstr("loopwright recover " + journal())));
  EXPECT_GT(rows(), 400);
}

TEST_F(Hangs, SignalsAreHeardWhileTheLibraryHangsWithItsLockHeld) {
  begin_to_hang("hang in read, request_stop", without_watchdog, "60");
  std::this_thread::sleep_for(600ms);
  kill(child_, SIGTERM);
  std::this_thread::sleep_for(2300ms);
  EXPECT_EQ(card_->get("dac.0"), 0) << "before anybody insists";
  kill(child_, SIGTERM);
  EXPECT_EQ(wait(), 128 + SIGTERM) << text("err");
}

TEST_F(Hangs, ASignalThatWouldOnlyHaltTheProcessEndsIt) {
  begin_to_hang("hang in read, request_stop", without_watchdog, "60");
  std::this_thread::sleep_for(600ms);
  kill(child_, SIGTSTP);
  std::this_thread::sleep_for(2300ms);
  kill(child_, SIGTSTP);
  EXPECT_EQ(wait(), 128 + SIGTSTP) << text("err");
  EXPECT_EQ(card_->get("dac.0"), 0);
}

TEST_F(Hangs, WhereTheDriverLetsNothingThroughTheProgramEndsAndTheWatchdogActs) {
  begin_to_hang("hang in read, request_stop, emergency_stop", patient);
  EXPECT_EQ(wait(), 1) << text("err");
  EXPECT_THAT(text("err"), HasSubstr("only the device's watchdog can put out its safe values"));
  EXPECT_EQ(card_->get("dac.0"), 0);
  EXPECT_EQ(card_->get("watchdog.expired"), 1);
}

TEST_F(Hangs, AWriteThatNeverReturnsLeavesTheOutputsSafe) {
  begin_to_hang("hang in write");
  EXPECT_EQ(wait(), 1) << text("err");
  EXPECT_EQ(card_->get("dac.0"), 0);
}

TEST_F(Hangs, AWriteThatReturnsTooLateIsAFault) {
  begin_to_hang("slow in write");
  EXPECT_EQ(wait(), 0) << text("err");
  EXPECT_THAT(text("result"),
              AllOf(HasSubstr("a write to the device did not return"), HasSubstr("confirmed")));
  expect_stopped("slow write");
}

TEST_F(Hangs, ARequestThatNeverReturnsDoesNotHoldUpAnOrderlyEnd) {
  begin_to_hang("hang in request_stop", patient);
  std::this_thread::sleep_for(400ms);
  kill(child_, SIGINT);
  EXPECT_EQ(wait(), 0) << text("err");
  EXPECT_THAT(text("result"), AllOf(HasSubstr("interrupted by SIGINT"), HasSubstr("confirmed")));
  expect_stopped("request that hangs");
}

TEST_F(Hangs, AStopThatHangsEndsTheProgram) {
  begin_to_hang("hang in end of sampling", without_watchdog, "1", "0.7");
  EXPECT_EQ(wait(), 1) << text("err");
  EXPECT_EQ(card_->get("dac.0"), 0);
}

TEST_F(Hangs, ACloseThatHangsEndsTheProgram) {
  begin_to_hang("hang in close", without_watchdog, "1", "0.7");
  EXPECT_EQ(wait(), 1) << text("err");
  EXPECT_THAT(text("err"), HasSubstr("safe values had been sent before"));
  EXPECT_EQ(card_->get("dac.0"), 0);
}

TEST(DetachedCall, ReturnsAtOnceAndLeavesACallBehindThatHangs) {
  const auto began = std::make_shared<std::atomic<int>>(0);
  const auto start = std::chrono::steady_clock::now();
  {
    DetachedCall hangs(
        [began] {
          for (++*began;;) std::this_thread::sleep_for(1s);
        },
        0);
    hangs.run();
    EXPECT_FALSE(hangs.wait(50));
    hangs.run();
    DetachedCall returns([began] { *began += 10; }, 0);
    for (int i = 0; i < 3; ++i) {
      returns.run();
      EXPECT_TRUE(returns.wait(1000));
    }
  }
  EXPECT_EQ(*began, 31) << "the call that hangs is made once";
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

}  // namespace
}  // namespace loopwright::hw::ends_test
