// At every end of a deployment the card's outputs are safe and the log is kept. Each end takes place in a
// child process, on a card in another process that can be inspected afterwards.
#include <dirent.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <csignal>
#include <fstream>
#include <thread>
#include "engine/json/problem.h"
#include "engine/record/journal.h"
#include "tests/hw/card_daemon.h"
#include "tests/hw/deployment.h"

namespace loopwright::hw::ends_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// For a busy computer: late commands are only counted, and the watchdog has a long timeout.
const std::string patient =
    R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "policy": {"on_overrun": "count", "on_lost": "count"}, "watchdog": {"timeout": 0.4}})";

/// The first row needs two samples, which must agree.
constexpr int rows_of_500_reads = 499;

// ---- the child: a deployment that ends as the environment variables request ----

volatile int zero = 0;
volatile int* volatile nowhere = nullptr;
[[gnu::noinline]] int endless(int n) {
  volatile char frame[4096];
  frame[0] = char(n);
  frame[1] = char(n);
  if (n == zero) return 0;  // never
  return frame[0] + endless(n + 1) + frame[1];
}
void access_beyond_the_end_of_a_file() {
  char name[] = "/tmp/loopwright_short_XXXXXX";
  const int file = mkstemp(name);
  unlink(name);
  if (ftruncate(file, 1) != 0) abort();
  auto* page = static_cast<volatile char*>(mmap(nullptr, 8192, PROT_READ, MAP_SHARED, file, 0));
  zero = page[4096];
}
/// The processor must see these crashes, not the sanitizer.
__attribute__((no_sanitize("undefined"))) void crash(const std::string& how) {
  if (how == "null pointer") *nowhere = 1;
  if (how == "division by zero") zero = 7 / zero;
  if (how == "illegal instruction") __builtin_trap();
  if (how == "abort") abort();
  if (how == "terminate") std::terminate();
  if (how == "stack overflow") zero = endless(1);
  if (how == "bus error") access_beyond_the_end_of_a_file();
  if (how == "exit") exit(3);
  if (how == "exception") throw std::runtime_error("thrown on purpose");
  if (how == "wrong exception") throw 17;
}

/// The card's driver, with an injected failure in the loop's thread.
class AccidentDriver final : public Driver {
 public:
  AccidentDriver(std::unique_ptr<Driver> driver, std::string how)
      : driver_(std::move(driver)), how_(std::move(how)) {}
  Capabilities capabilities() const override { return driver_->capabilities(); }
  Status open() override { return driver_->open(); }
  Status configure(std::span<const double> safe) override { return driver_->configure(safe); }
  Status start(double period_s) override { return driver_->start(period_s); }
  std::string describe(Status status) const override { return driver_->describe(status); }
  Status read(RawSample& sample, std::span<double> raw) noexcept override {
    if (++reads_ > 500) {
      if (how_ == "hang")
        for (;;) std::this_thread::sleep_for(1s);
      crash(how_);
    }
    return driver_->read(sample, raw);
  }
  Status write(std::span<const double> raw) noexcept override { return driver_->write(raw); }
  Status kick() noexcept override { return driver_->kick(); }
  void request_stop() noexcept override { driver_->request_stop(); }
  void emergency_stop(std::span<const double> safe) noexcept override { driver_->emergency_stop(safe); }
  void stop_sampling() noexcept override { driver_->stop_sampling(); }
  void disarm() noexcept override { driver_->disarm(); }
  bool watchdog_took_over() noexcept override { return driver_->watchdog_took_over(); }
  void close() noexcept override { driver_->close(); }
  Status rearm() override { return driver_->rearm(); }

 private:
  std::unique_ptr<Driver> driver_;
  std::string how_;
  int reads_ = 0;
};

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
  Deployed deployed(patient, load);
  if (where == "loop") {
    Problems problems;
    auto driver = find_driver("quanser")->make(deployed.hardware.device, problems);
    deployed.device = std::make_unique<IoDevice>(deployed.hardware.device,
                                                 std::make_unique<AccidentDriver>(std::move(driver), how));
  }
  DeployOptions options;
  options.system.priority = 0;
  options.journal = told("END_JOURNAL");
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

class Ends : public testing::Test {
 protected:
  Ends() {
    folder_.with("card.json", R"({"plant.cogging": 0, "plant.tilt": 0.2})");
    card_ = std::make_unique<CardDaemon>(folder_.path("world"), folder_.path("card.json"));
  }
  void begin(const std::string& where, const std::string& how, const std::string& stop = "") {
    std::vector<std::string> environment{"HIL_LIBRARY=" + emulator_library(),
                                         "HIL_EMU_SHARED=" + folder_.path("world"),
                                         "END_WHERE=" + where,
                                         "END_HOW=" + how,
                                         "END_STOP=" + stop,
                                         "END_JOURNAL=" + journal(),
                                         "END_RESULT=" + folder_.path("result"),
                                         "ASAN_OPTIONS=handle_segv=0:handle_sigbus=0:handle_sigfpe=0:handle_"
                                         "sigill=0:handle_abort=0:detect_leaks=0:"
                                         "use_sigaltstack=0"};
    for (char** e = environ; *e; ++e)
      if (!std::string_view(*e).starts_with("HIL_") && !std::string_view(*e).starts_with("ASAN_") &&
          !std::string_view(*e).starts_with("GTEST_"))
        environment.emplace_back(*e);
    std::vector<char*> raw;
    for (std::string& e : environment) raw.push_back(e.data());
    raw.push_back(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    dup2(open(folder_.path("err").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    const int out = open("/dev/null", O_WRONLY);
    dup2(out, STDOUT_FILENO);
    execle("/proc/self/exe", "test", "--gtest_also_run_disabled_tests", "--gtest_filter=ChildOfEnds.*",
           static_cast<char*>(nullptr), raw.data());
    _exit(98);
  }
  /// Its exit code; 128 + signal if a signal ended it, 999 if it did not end within 20 s.
  int wait() {
    for (int i = 0; i < 2000; ++i) {
      int status = 0;
      if (waitpid(child_, &status, WNOHANG) == child_)
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      std::this_thread::sleep_for(10ms);
    }
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    return 999;
  }
  bool wait_until_driven(double time = 0) {
    for (int i = 0; i < 2000; ++i) {
      if (card_->get("watchdog.armed") == 1 && card_->get("dac.0") != 0 && last_time() >= time) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  std::string journal() const { return folder_.path("log.csv.journal"); }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_.path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  int64_t rows() const try { return JournalReader(journal()).survey().rows; } catch (const InputError&) {
    return 0;
  }
  double last_time() const { return 1e-3 * double(rows()); }
  /// By the program, not by the card's watchdog.
  void expect_stopped(const std::string& what) {
    EXPECT_EQ(card_->get("dac.0"), 0) << what;
    EXPECT_EQ(card_->get("watchdog.expired"), 0) << what;
    EXPECT_EQ(card_->get("open"), 0) << what;
  }
  std::vector<pid_t> threads() const {
    std::vector<pid_t> all;
    const std::string tasks = "/proc/" + std::to_string(child_) + "/task";
    if (DIR* folder = opendir(tasks.c_str())) {
      while (const dirent* entry = readdir(folder))
        if (entry->d_name[0] != '.') all.push_back(std::stoi(entry->d_name));
      closedir(folder);
    }
    std::ranges::sort(all);
    return all;
  }
  DiagramFolder folder_;
  std::unique_ptr<CardDaemon> card_;
  pid_t child_ = -1;
};

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
    ASSERT_GE(count, 5u) << "main, loop, watcher, and two for the log";
    syscall(SYS_tgkill, child_, all[i], SIGSEGV);
    EXPECT_EQ(wait(), 128 + SIGSEGV) << "thread " << i << text("err");
    expect_stopped("thread " + std::to_string(i));
  }
}

TEST_F(Ends, ALoopThatHangsInItsDriverIsLeftAtTheThirdSignal) {
  begin("loop", "hang");
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
