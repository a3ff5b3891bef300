/// Starts this program again as a deployment that ends in some way, on a card in another process that can be
/// inspected afterwards.
#pragma once
#include <dirent.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>
#include "engine/json/problem.h"
#include "engine/record/journal.h"
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/hw/card_daemon.h"
#include "tests/hw/emulated_card.h"

namespace loopwright::hw::ends_test {

using namespace std::chrono_literals;

/// For a busy computer: late commands are only counted, and the watchdog has a long timeout.
const std::string patient =
    R"({"clock": {"buffer": 1, "overflow": "overwrite"}, "policy": {"on_overrun": "count", "on_lost": "count"}, "watchdog": {"timeout": 0.4}})";

class Ends : public testing::Test {
 protected:
  Ends() {
    folder_.with("card.json", R"({"plant.cogging": 0, "plant.tilt": 0.2})");
    card_ = std::make_unique<CardDaemon>(folder_.path("world"), folder_.path("card.json"));
  }
  /// `device`: a patch of the device file. `end_timeout`: that of the deployment.
  void begin(const std::string& where, const std::string& how, const std::string& stop = "",
             const std::string& device = patient, const std::string& end_timeout = "10") {
    std::vector<std::string> environment{"HIL_LIBRARY=" + emulator_library(),
                                         "HIL_EMU_SHARED=" + folder_.path("world"),
                                         "END_WHERE=" + where,
                                         "END_HOW=" + how,
                                         "END_STOP=" + stop,
                                         "END_DEVICE=" + device,
                                         "END_TIMEOUT=" + end_timeout,
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
      if (card_->get("dac.0") != 0 && last_time() >= time) return true;
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

}  // namespace loopwright::hw::ends_test
