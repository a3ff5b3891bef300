// At every end of a deployment the card's outputs are safe and the log is kept. Each end takes place in a
// child process, on a card in another process that can be inspected afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <csignal>
#include <fstream>
#include <thread>
#include "tests/hw/deployment.h"
#include "tests/hw/realtime/accident.h"
#include "tests/hw/realtime/ends.h"

namespace loopwright::hw::ends_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// The first row needs two samples, which must agree.
constexpr int rows_of_500_reads = 499;

// ---- the child: a deployment that ends as the environment variables request ----

std::string told(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}
void loop_throws() { throw std::runtime_error("thrown on purpose"); }
void loop_crashes() { crash("null pointer"); }

/// No test: the other tests start this program again to run it in a process that may crash.
TEST(ChildOfEnds, DISABLED_DeploysUntilItsEnd) {
  const std::string where = told("END_WHERE"), how = told("END_HOW");
  LoadOptions load;
  load.set = {{"solver.stop", told("END_STOP").empty() ? "60" : told("END_STOP")}};
  Deployed deployed(told("END_DEVICE"), load);
  if (where == "loop") {
    Problems problems;
    auto driver = find_driver("quanser")->make(deployed.hardware.device, problems);
    deployed.device = std::make_unique<IoDevice>(deployed.hardware.device,
                                                 std::make_unique<AccidentDriver>(std::move(driver), how));
  }
  DeployOptions options;
  options.system.priority = 0;
  options.journal = told("END_JOURNAL");
  options.end_timeout = std::stod(told("END_TIMEOUT"));
  if (where == "ready") options.ready = [&](const std::vector<std::string>&) { crash(how); };
  if (where == "progress")
    options.progress = [&](const LiveValues& now) {
      if (now.time > 0.5) crash(how);
    };
  if (where == "loop_begins") options.loop_begins = how == "exception" ? loop_throws : loop_crashes;
  if (where == "loop_ends") options.loop_ends = how == "exception" ? loop_throws : loop_crashes;
  const DeployResult result = deployed.run(options);
  std::ofstream(told("END_RESULT")) << int(result.status) << "\n"
                                    << to_name(result.outputs_safe) << "\n"
                                    << result.message << "\n";
}

// ---- the parent ----

TEST_F(Ends, AnExceptionInACallbackStopsTheMachineAndKeepsTheLog) {
  for (const char* where :
       {"ready", "progress", "loop_begins", "loop_ends", "progress with another exception"}) {
    std::filesystem::remove(journal());
    const bool is_other = std::string_view(where).find(' ') != std::string_view::npos;
    begin(is_other ? "progress" : where, is_other ? "wrong exception" : "exception",
          std::string_view(where) == "loop_ends" ? "0.3" : "");
    EXPECT_EQ(wait(), 0) << where << text("err");
    const bool is_untouched = std::string_view(where) == "ready";  // the device is open, nothing was sent
    EXPECT_THAT(text("result"), HasSubstr(is_untouched ? "untouched" : "confirmed")) << where;
    EXPECT_THAT(text("result"), HasSubstr(is_other ? "unknown exception" : "thrown on purpose")) << where;
    EXPECT_EQ(text("result")[0], char('0' + int(RunStatus::failed))) << where;
    expect_stopped(where);
    const JournalReader log(journal());
    EXPECT_TRUE(log.survey().has_end) << where;
    EXPECT_GE(log.survey().rows, std::string_view(where).starts_with("progress") ? 400 : 0) << where;
  }
}

TEST_F(Ends, ACrashInTheMainThreadStopsTheMachineAndKeepsTheLog) {
  for (const auto& [how, signal] :
       {std::pair{"null pointer", SIGSEGV}, std::pair{"stack overflow", SIGSEGV}, std::pair{"abort", SIGABRT},
        std::pair{"terminate", SIGABRT}, std::pair{"division by zero", SIGFPE},
        std::pair{"illegal instruction", SIGILL}, std::pair{"bus error", SIGBUS}}) {
    std::filesystem::remove(journal());
    begin("progress", how);
    EXPECT_EQ(wait(), 128 + signal) << how << text("err");
    expect_stopped(how);
    EXPECT_GT(rows(), 400) << how;
    EXPECT_THAT(text("err"), HasSubstr("the device took the safe values and is closed")) << how;
    EXPECT_THAT(text("err"), HasSubstr("loopwright recover " + journal())) << how;
  }
}

TEST_F(Ends, ACrashInTheLoopsThreadStopsTheMachineAndKeepsTheLog) {
  for (const auto& [how, signal] : {std::pair{"null pointer", SIGSEGV}, std::pair{"stack overflow", SIGSEGV},
                                    std::pair{"abort", SIGABRT}, std::pair{"exception", SIGABRT}}) {
    std::filesystem::remove(journal());
    begin("loop", how);
    EXPECT_EQ(wait(), 128 + signal) << how << text("err");
    expect_stopped(how);
    EXPECT_EQ(rows(), rows_of_500_reads) << how << ": not a row is lost";
  }
}

TEST_F(Ends, AnExitFromAnywhereStopsTheMachine) {
  begin("progress", "exit");
  EXPECT_EQ(wait(), 3) << text("err");
  expect_stopped("exit(3)");
}

TEST_F(Ends, ACrashBeforeTheFirstSampleLeavesTheCardClosed) {
  for (const char* where : {"ready", "loop_begins"}) {
    std::filesystem::remove(journal());
    begin(where, "null pointer");
    EXPECT_EQ(wait(), 128 + SIGSEGV) << where << text("err");
    expect_stopped(where);
    EXPECT_THAT(text("err"), HasSubstr("SIGSEGV: the device took the safe values and is closed")) << where;
    EXPECT_THAT(text("err"), testing::Not(HasSubstr("in motion")));
  }
}

TEST_F(Ends, AFatalSignalToAnyThreadStopsTheMachine) {
  size_t count = 1;
  for (size_t i = 0; i < count; ++i) {
    std::filesystem::remove(journal());
    begin("", "");
    ASSERT_TRUE(wait_until_driven(0.2)) << text("err");
    const std::vector<pid_t> all = threads();
    count = all.size();
    ASSERT_GE(count, 7u) << "main, loop, watcher, two that call the driver, and two for the log";
    syscall(SYS_tgkill, child_, all[i], SIGSEGV);
    EXPECT_EQ(wait(), 128 + SIGSEGV) << "thread " << i << text("err");
    expect_stopped("thread " + std::to_string(i));
  }
}

TEST_F(Ends, ALoopThatHangsInItsDriverIsLeftAtTheThirdSignal) {
  begin("loop", "hang in read");
  ASSERT_TRUE(wait_until_driven()) << text("err");
  std::this_thread::sleep_for(800ms);  // now it hangs, and the watchdog is not reset
  kill(child_, SIGINT);
  std::this_thread::sleep_for(50ms);
  kill(child_, SIGINT);
  std::this_thread::sleep_for(2500ms);
  kill(child_, SIGINT);
  EXPECT_EQ(wait(), 128 + SIGINT) << text("err");
  EXPECT_EQ(card_->get("dac.0"), 0);
  EXPECT_EQ(rows(), rows_of_500_reads);
}

TEST_F(Ends, AKillLeavesTheOutputsToTheWatchdogAndTheLogUpToTheLastSecond) {
  begin("", "");
  ASSERT_TRUE(wait_until_driven(1.5)) << text("err");
  kill(child_, SIGKILL);
  EXPECT_EQ(wait(), 128 + SIGKILL);
  const double killed = card_->get("time"), sampled = 1e-3 * card_->get("samples");
  for (int i = 0; i < 200 && card_->get("watchdog.expired") == 0; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(card_->get("dac.0"), 0);
  EXPECT_LE(card_->get("watchdog.expired_at"), killed + 0.4);
  EXPECT_GE(last_time(), sampled - 1) << "at most a second is lost";
}

}  // namespace
}  // namespace loopwright::hw::ends_test
