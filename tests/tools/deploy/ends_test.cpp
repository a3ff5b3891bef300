// At every end of the program the card's outputs are safe, the card is closed, and the log is kept: signals,
// a terminal or readers that disappear, disks that are full or stall. The card runs in its own process.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <utmp.h>
#include <nlohmann/json.hpp>
#include <thread>
#include "engine/record/csv.h"
#include "tests/hw/card_daemon.h"
#include "tests/hw/device_file.h"
#include "tests/hw/emulated_card.h"
#include "tests/tools/command/program.h"
#include "where.h"

namespace loopwright::ends_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using namespace std::chrono_literals;

const std::string conventional = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/conventional.json";
/// For a busy computer: late commands are only counted, and the watchdog has a long timeout.
const std::string patient =
    R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "policy": {"on_overrun": "count", "on_lost": "count"}, "watchdog": {"timeout": 0.4}})";

class EndsOfTheProgram : public testing::Test {
 protected:
  EndsOfTheProgram() {
    folder_.with("card.json", R"({"plant.cogging": 0, "plant.tilt": 0.2})");
    folder_.with("device.json", hw::device_text(patient));
    card_ = std::make_unique<hw::CardDaemon>(folder_.path("world"), folder_.path("card.json"));
  }
  /// Starts deploy. `prepare` is called in the child before it.
  void begin(
      std::vector<std::string> more, const std::function<void()>& prepare = [] {}) {
    std::vector<std::string> all{program(),
                                 "deploy",
                                 conventional,
                                 "--variant",
                                 "stage=quanser",
                                 "--set",
                                 "stage.device=" + folder_.path("device.json"),
                                 "--priority",
                                 "0"};
    all.insert(all.end(), more.begin(), more.end());
    std::vector<char*> raw;
    for (std::string& argument : all) raw.push_back(argument.data());
    raw.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    setenv("HIL_LIBRARY", hw::emulator_library().c_str(), 1);
    setenv("HIL_EMU_SHARED", folder_.path("world").c_str(), 1);
    setenv("ASAN_OPTIONS",
           "handle_segv=0:handle_sigbus=0:handle_sigfpe=0:handle_sigill=0:handle_abort=0:detect_leaks=0:"
           "use_sigaltstack=0:verify_asan_link_order=0",
           1);
    dup2(open(folder_.path("out").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(folder_.path("err").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    prepare();
    execv(raw[0], raw.data());
    _exit(98);
  }
  std::vector<std::string> logged(const std::string& stop = "60") {
    std::filesystem::remove(log()), std::filesystem::remove(journal());
    std::filesystem::remove(folder_.path("figures.json"));
    return {"--set", "solver.stop=" + stop, "-o", log(), "--json", folder_.path("figures.json")};
  }
  /// Exit code; 128 + signal; 999: it did not end within 30 s.
  int wait() {
    for (int i = 0; i < 3000; ++i) {
      int status = 0;
      if (waitpid(process_, &status, WNOHANG) == process_)
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      std::this_thread::sleep_for(10ms);
    }
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    return 999;
  }
  bool wait_until_driven() {
    for (int i = 0; i < 2000; ++i) {
      if (card_->get("watchdog.armed") == 1 && card_->get("dac.0") != 0) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  /// By the program, not by the card's watchdog.
  void expect_stopped(const std::string& what) {
    EXPECT_EQ(card_->get("dac.0"), 0) << what;
    EXPECT_EQ(card_->get("watchdog.expired"), 0) << what;
    EXPECT_EQ(card_->get("open"), 0) << what;
  }
  /// The log exists as a readable CSV up to this time [s]. A busy computer may lose samples before it.
  void expect_log(const std::string& what, double reaches = 0.05) {
    Problems problems;
    const Recording recording = read_csv(log(), problems, {.allow_not_finite = true});
    EXPECT_EQ(problems.text(), "") << what;
    EXPECT_GE(last_time(recording), reaches) << what;
    EXPECT_FALSE(std::filesystem::exists(journal())) << what;
  }
  void expect_recoverable(const std::string& what, double reaches = 0.05) {
    EXPECT_FALSE(std::filesystem::exists(log())) << what;
    const Outcome outcome = loopwright_program({"recover", journal(), "-o", log()});
    EXPECT_EQ(outcome.code, 0) << what << outcome.err << outcome.out;
    Problems problems;
    EXPECT_GE(last_time(read_csv(log(), problems, {.allow_not_finite = true})), reaches)
        << what << outcome.out;
  }
  static double last_time(const Recording& log) { return log.rows() ? log.columns[0].values.back() : -1; }
  nlohmann::json figures() { return nlohmann::json::parse(text_of(folder_.path("figures.json"))); }
  std::string log() const { return folder_.path("log.csv"); }
  std::string journal() const { return log() + ".journal"; }
  std::string err() const { return text_of(folder_.path("err")); }

  DiagramFolder folder_;
  std::unique_ptr<hw::CardDaemon> card_;
  pid_t process_ = -1;
};

TEST_F(EndsOfTheProgram, EverySignalThatAsksToEndIsAnOrderlyEnd) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGXCPU, SIGUSR1, SIGUSR2, SIGPWR,
                           SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGSTKFLT, SIGRTMIN, SIGRTMAX}) {
    const std::string what = strsignal(signal);
    begin(logged());
    ASSERT_TRUE(wait_until_driven()) << what << err();
    std::this_thread::sleep_for(100ms);
    kill(process_, signal);
    EXPECT_EQ(wait(), 130) << what << err();
    expect_stopped(what);
    expect_log(what);
    EXPECT_EQ(figures().at("outputs_safe"), "confirmed") << what;
    EXPECT_EQ(figures().at("status"), "interrupted") << what;
  }
}

TEST_F(EndsOfTheProgram, SignalsOfWritingAreNoEnd) {
  begin(logged("1"));
  ASSERT_TRUE(wait_until_driven()) << err();
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTTOU, SIGTTIN}) kill(process_, signal);
  EXPECT_EQ(wait(), 0) << err();
  expect_stopped("ignored signals");
  expect_log("ignored signals", 0.9);
}

TEST_F(EndsOfTheProgram, AFatalSignalStopsTheMachineAndThenEndsTheProcess) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP}) {
    const std::string what = strsignal(signal);
    begin(logged());
    ASSERT_TRUE(wait_until_driven()) << what << err();
    std::this_thread::sleep_for(150ms);
    kill(process_, signal);
    EXPECT_EQ(wait(), 128 + signal) << what << err();
    expect_stopped(what);
    EXPECT_THAT(err(), HasSubstr("loopwright recover " + journal()));
    expect_recoverable(what);
  }
}

TEST_F(EndsOfTheProgram, HastySignalsCostNeitherTheStopNorTheLog) {
  for (const int pause_ms : {0, 2, 5, 7, 10, 15, 20, 40, 80, 200}) {
    const std::string what = std::to_string(pause_ms) + " ms";
    begin(logged());
    ASSERT_TRUE(wait_until_driven()) << what << err();
    std::this_thread::sleep_for(100ms);
    for (int i = 0; i < 3; ++i) {
      kill(process_, i == 1 ? SIGTERM : SIGINT);
      std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
    }
    EXPECT_EQ(wait(), 130) << what << err();
    expect_stopped(what);
    expect_log(what);
    EXPECT_EQ(figures().at("outputs_safe"), "confirmed") << what;
  }
}

TEST_F(EndsOfTheProgram, AReaderOfTheMessagesThatGoesAwayIsNoEnd) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  begin(logged("2"), [&] { dup2(ends[1], STDERR_FILENO); });
  close(ends[1]);
  ASSERT_TRUE(wait_until_driven());
  close(ends[0]);
  EXPECT_EQ(wait(), 0);
  expect_stopped("nobody reads");
  expect_log("nobody reads", 1.8);
}

TEST_F(EndsOfTheProgram, MessagesThatNobodyReadsHoldNothingUp) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
  while (write(ends[1], "full ", 5) > 0) {
  }
  fcntl(ends[1], F_SETFL, 0);
  begin(logged(), [&] { dup2(ends[1], STDERR_FILENO); });
  ASSERT_TRUE(wait_until_driven());
  std::this_thread::sleep_for(500ms);
  kill(process_, SIGINT);
  EXPECT_EQ(wait(), 130);
  expect_stopped("a full pipe");
  expect_log("a full pipe", 0.2);
  close(ends[0]), close(ends[1]);
}

TEST_F(EndsOfTheProgram, MessagesThatCannotBeWrittenAreNoEnd) {
  for (const char* where : {"/dev/full", ""}) {
    begin(logged("1"), [&] {
      close(STDERR_FILENO);
      if (*where) dup2(open(where, O_WRONLY), STDERR_FILENO);
    });
    EXPECT_EQ(wait(), 0) << where;
    expect_stopped(where);
    expect_log(where, 0.9);
    EXPECT_THAT(text_of(log()), Not(HasSubstr("cycles"))) << "no message lands in another file";
  }
}

TEST_F(EndsOfTheProgram, FiguresThatCannotBeWrittenFailAfterTheStop) {
  for (const char* where : {"/dev/full", ""}) {
    auto arguments = logged("1");
    arguments.back() = "-";
    begin(arguments, [&] {
      close(STDOUT_FILENO);
      if (*where) dup2(open(where, O_WRONLY), STDOUT_FILENO);
    });
    EXPECT_EQ(wait(), 1) << err();
    EXPECT_THAT(err(), HasSubstr("the figures cannot be written to the standard output"));
    expect_stopped(where);
    expect_log(where, 0.9);
  }
}

TEST_F(EndsOfTheProgram, AClosedTerminalIsAnOrderlyEnd) {
  int terminal = -1, inside = -1;
  ASSERT_EQ(openpty(&terminal, &inside, nullptr, nullptr, nullptr), 0);
  fcntl(terminal, F_SETFD, FD_CLOEXEC);
  begin(logged(), [&] { login_tty(inside); });
  close(inside);
  ASSERT_TRUE(wait_until_driven());
  std::this_thread::sleep_for(300ms);
  close(terminal);
  EXPECT_EQ(wait(), 130);
  expect_stopped("closed terminal");
  expect_log("closed terminal", 0.1);
}

TEST_F(EndsOfTheProgram, AFullDiskEndsTheRunSafelyAndKeepsWhatWasWritten) {
  begin(logged(), [] {
    const rlimit limit{64 << 10, 64 << 10};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  EXPECT_EQ(wait(), 1) << err();
  expect_stopped("full disk");
  EXPECT_THAT(err(),
              AllOf(HasSubstr("the log cannot be written: File too large"), HasSubstr("loopwright recover")));
  expect_recoverable("full disk", 0.2);
}

TEST_F(EndsOfTheProgram, AJournalThatIsGoneIsNotSaidToBeKept) {
  for (const char* how : {"removed", "truncated"}) {
    begin(logged());
    ASSERT_TRUE(wait_until_driven()) << err();
    std::this_thread::sleep_for(300ms);
    if (std::string_view(how) == "removed")
      std::filesystem::remove(journal());
    else
      std::filesystem::resize_file(journal(), 0);
    std::this_thread::sleep_for(200ms);
    kill(process_, SIGINT);
    EXPECT_EQ(wait(), 130) << how << err();
    expect_stopped(how);
    EXPECT_THAT(err(), AllOf(HasSubstr("the log is lost: its journal " + journal()),
                             Not(HasSubstr("is kept in")), Not(HasSubstr("error: error:"))))
        << how;
    EXPECT_FALSE(std::filesystem::exists(log())) << how;
  }
}

TEST_F(EndsOfTheProgram, AStalledDiskHoldsUpNeitherTheLoopNorTheStop) {
  const std::string flag = folder_.path("stalled");
  begin(logged(), [&] {
    setenv("LD_PRELOAD", LOOPWRIGHT_BINARY "/lib/libstalled_disk.so", 1);
    setenv("STALLED_DISK", flag.c_str(), 1);
  });
  ASSERT_TRUE(wait_until_driven()) << err();
  std::this_thread::sleep_for(1500ms);
  folder_.with("stalled", "");
  std::this_thread::sleep_for(1s);
  EXPECT_NE(card_->get("dac.0"), 0) << "the loop goes on";
  EXPECT_EQ(card_->get("watchdog.expired"), 0);
  kill(process_, SIGINT);
  for (int i = 0; i < 100 && card_->get("open") != 0; ++i) std::this_thread::sleep_for(10ms);
  expect_stopped("stalled disk: the machine does not wait for it");
  std::this_thread::sleep_for(2500ms);
  kill(process_, SIGINT);  // nor does a person wait
  EXPECT_EQ(wait(), 130) << err();
  EXPECT_THAT(err(), AllOf(HasSubstr("the disk does not answer"), HasSubstr("loopwright recover")));
  std::filesystem::remove(flag);
  EXPECT_EQ(figures().at("outputs_safe"), "confirmed");
  expect_recoverable("stalled disk", 0.5);
}

TEST_F(EndsOfTheProgram, AKilledProgramLosesAtMostASecondOfItsLog) {
  begin(logged());
  ASSERT_TRUE(wait_until_driven()) << err();
  std::this_thread::sleep_for(1500ms);
  kill(process_, SIGKILL);
  EXPECT_EQ(wait(), 128 + SIGKILL);
  const double samples = card_->get("samples");
  for (int i = 0; i < 200 && card_->get("watchdog.expired") == 0; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(card_->get("dac.0"), 0) << "by the watchdog";
  const Outcome refused = loopwright_program({"deploy", conventional, "--variant", "stage=quanser", "--set",
                                              "stage.device=" + folder_.path("device.json"), "-o", log()});
  EXPECT_EQ(refused.code, 2) << "the only copy of a log is not overwritten";
  EXPECT_THAT(refused.err, HasSubstr("loopwright recover"));
  // Samples that the loop missed have no row, so that rows are counted by time.
  const Outcome outcome = loopwright_program({"recover", journal(), "-o", log()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("its end is missing"));
  Problems problems;
  const Recording recording = read_csv(log(), problems, {.allow_not_finite = true});
  ASSERT_GT(recording.rows(), 0u);
  EXPECT_GE(double(recording.rows()), samples - 1000);
  EXPECT_THAT(text_of(log()), HasSubstr("# incomplete: "));
}

TEST_F(EndsOfTheProgram, WithoutAWatchdogNothingMovesUnlessItIsAccepted) {
  folder_.with("device.json",
               hw::device_text(R"({"watchdog": null, "clock": {"buffer": 1, "overflow": "overwrite"},
                                                  "policy": {"on_overrun": "count", "on_lost": "count"}})"));
  begin(logged("0.5"));
  EXPECT_EQ(wait(), 2);
  EXPECT_THAT(err(), AllOf(HasSubstr("has no watchdog"), HasSubstr("--no-watchdog")));
  EXPECT_EQ(card_->get("samples"), 0) << "the card was not touched";
  EXPECT_FALSE(std::filesystem::exists(journal()));
  auto arguments = logged("0.5");
  arguments.push_back("--no-watchdog");
  begin(arguments);
  EXPECT_EQ(wait(), 0) << err();
  EXPECT_THAT(err(), HasSubstr("there is no watchdog: nothing puts them out"));
  expect_stopped("without a watchdog");
}

}  // namespace
}  // namespace loopwright::ends_test
