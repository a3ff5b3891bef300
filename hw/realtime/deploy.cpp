#include "hw/realtime/deploy.h"
#include <fmt/format.h>
#include <pthread.h>
#include <chrono>
#include <csignal>
#include <semaphore>
#include <thread>
#include "hw/realtime/control_loop.h"

namespace loopwright::hw {
namespace {

using namespace std::chrono_literals;

/// SIGINT, SIGTERM and SIGHUP wait in line for whoever asks, in every thread that is started while this
/// lives.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigemptyset(&set_);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set_, signal);
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  /// The signal that came within the time; 0: none.
  int wait(std::chrono::nanoseconds most) const {
    const timespec time{most.count() / 1'000'000'000, most.count() % 1'000'000'000};
    return std::max(0, sigtimedwait(&set_, nullptr, &time));
  }

 private:
  sigset_t set_, before_;
};

size_t rows_of_log(const Plan& plan, const Hardware& hardware, size_t columns, size_t most_bytes) {
  const auto rows = size_t((plan.stop_tick - plan.start_tick) / hardware.period_ticks + 1);
  return std::clamp<size_t>(rows, 1, std::max<size_t>(1, most_bytes / (columns * sizeof(double))));
}

class Deployment {
 public:
  Deployment(const Plan& plan, const Hardware& hardware, IoDevice& device, const DeployOptions& options)
      : plan_(plan),
        hardware_(hardware),
        device_(device),
        options_(options),
        is_simulated_(device.description().clock.time == Time::simulated),
        columns_(log_columns(plan, hardware)),
        log_(columns_.size(), rows_of_log(plan, hardware, columns_.size(), options.log_bytes)),
        loop_(plan, hardware, device, clock(), log_, columns_) {
    for (const LogColumn& column : columns_) {
      result_.recording.columns.push_back({column.name, column.unit, {}});
      result_.recording.columns.back().values.reserve(
          rows_of_log(plan, hardware, columns_.size(), options.log_bytes));
    }
  }

  DeployResult run() {
    const BlockedSignals signals;
    SystemRequest request = options_.system;
    if (is_simulated_) request = {0, -1, false};  // nothing is to be on time
    const RealTimeProcess process(request, result_.system);
    std::thread loop([&] { run_loop(request); });
    is_prepared_.acquire();
    if (set_up()) {
      std::thread monitor([&] { watch(signals); });
      may_begin_.release();
      follow();
      monitor.join();
    } else {
      is_called_off_ = true;
      may_begin_.release();
    }
    loop.join();
    device_.close();
    finish();
    return std::move(result_);
  }

 private:
  Clock& clock() {
    if (options_.clock) return *options_.clock;
    return is_simulated_ ? static_cast<Clock&>(simulated_clock_) : computer_clock_;
  }

  /// The real-time thread, from its scheduling to its safe outputs.
  void run_loop(const SystemRequest& request) {
    make_thread_real_time(request, result_.system);
    loop_.warm_up();
    is_prepared_.release();
    may_begin_.acquire();
    if (is_called_off_) return;
    started_ = device_.start(hardware_.period_s);
    if (started_.ok()) {
      if (options_.loop_begins) options_.loop_begins();
      loop_.run();
      if (options_.loop_ends) options_.loop_ends();
    }
    result_.outputs_safe = device_.stop();
    is_done_.release();
  }

  bool fail(std::string message, Status status = {}) {
    result_.status = RunStatus::failed;
    result_.message = std::move(message);
    result_.fault = status;
    return false;
  }

  /// Everything up to the first sample. False: called off, with nothing moved.
  bool set_up() {
    if (options_.require_real_time && !is_simulated_ && !result_.system.all_granted()) {
      result_.outputs_safe = OutputsSafe::confirmed;  // nothing was touched
      return fail("the system does not grant what a loop in real time needs:\n" + to_text(result_.system));
    }
    Status status = device_.open();
    if (status.ok()) status = device_.preset();
    result_.device = device_.facts();
    if (!status.ok()) {
      const std::string what = device_.describe(status);
      result_.outputs_safe = device_.stop();
      return fail(fmt::format("{} cannot be set up: {}", device_.description().path, what), status);
    }
    if (options_.ready) {
      std::vector<std::string> lines = result_.device;
      for (const Granted& item : result_.system.items)
        lines.push_back(fmt::format("{}: {}", item.what, item.answer));
      options_.ready(lines);
    }
    return true;
  }

  /// Signals, and reads that do not return.
  void watch(const BlockedSignals& signals) {
    const double usual = is_simulated_ ? 5 : std::max(0.25, 10 * hardware_.period_s);
    const double longest = options_.read_timeout > 0 ? options_.read_timeout : usual;
    while (!has_ended_) {
      if (signals.wait(5ms) > 0) loop_.request_stop();
      if (!has_timed_out_ && 1e-9 * double(loop_.waiting_ns()) > longest)
        has_timed_out_ = true, loop_.request_stop();
    }
  }

  void take_rows() {
    log_.drain([&](std::span<const double> row) {
      for (size_t i = 0; i < row.size(); ++i) result_.recording.columns[i].values.push_back(row[i]);
    });
  }

  /// Empties the log and shows how it goes, until the loop has ended.
  void follow() {
    int turn = 0;
    while (!is_done_.try_acquire_for(20ms)) {
      if (options_.drains_log) take_rows();
      if (options_.progress && ++turn % 10 == 0) options_.progress(loop_.live());
    }
    has_ended_ = true;
    take_rows();
  }

  void finish() {
    result_.statistics = loop_.statistics();
    result_.time = loop_.stepper().run().now().time;
    if (result_.status == RunStatus::finished) explain_end();
    auto& facts = result_.recording.facts;
    facts.emplace_back("title", plan_.title);
    for (auto& fact : plan_.identity.facts()) facts.push_back(std::move(fact));
    facts.emplace_back("seed", fmt::format("{}", plan_.seed));
    facts.emplace_back("device", device_.description().path);
    facts.emplace_back("outputs_safe", std::string(to_name(result_.outputs_safe)));
    if (result_.status != RunStatus::finished) facts.emplace_back("incomplete", result_.message);
    for (const auto& [name, value] : plan_.parameters) facts.emplace_back("parameter " + name, value);
  }

  void explain_end() {
    using Why = LoopEnd::Why;
    const LoopEnd& end = loop_.end();
    const auto at = fmt::format("at t = {:g} s", result_.time);
    if (!started_.ok()) {
      fail(fmt::format("the device does not start: {}", device_.describe(started_)), started_);
    } else if (has_timed_out_) {
      fail(fmt::format("a read of the device did not return, {}", at), {Code::device_fault});
    } else if (end.why == Why::asked) {
      result_.status = RunStatus::interrupted;
      result_.message = "interrupted " + at;
    } else if (end.why == Why::status && end.status.code == Code::stopped) {
      fail("the device stopped sampling " + at, end.status);
    } else if (end.why == Why::status) {
      fail(fmt::format("{}, {}", device_.describe(end.status), at), end.status);
    } else if (end.why == Why::step_failed) {
      fail(loop_.stepper().fault());
    } else if (end.why == Why::overruns) {
      std::string slowest;
      for (size_t i = 0; i < std::min<size_t>(3, result_.statistics.blocks.size()); ++i)
        slowest += fmt::format("{}{} {:.1f} us", i ? ", " : "", result_.statistics.blocks[i].path,
                               result_.statistics.blocks[i].longest_us);
      fail(fmt::format("{} commands in a row came too late, {}; longest read {:.0f} us, step {:.0f} us, "
                       "write {:.0f} us; "
                       "the slowest blocks: {}",
                       result_.statistics.most_overruns_in_row, at,
                       1e-3 * double(result_.statistics.read.longest_ns()),
                       1e-3 * double(result_.statistics.step.longest_ns()),
                       1e-3 * double(result_.statistics.write.longest_ns()), slowest),
           end.status);
    }
  }

  const Plan& plan_;
  const Hardware& hardware_;
  IoDevice& device_;
  const DeployOptions& options_;
  const bool is_simulated_;
  MonotonicClock computer_clock_;
  SimulatedClock simulated_clock_;
  std::vector<LogColumn> columns_;
  LogRing log_;
  ControlLoop loop_;
  DeployResult result_;
  Status started_;
  bool is_called_off_ = false;
  std::binary_semaphore is_prepared_{0}, may_begin_{0}, is_done_{0};
  std::atomic<bool> has_ended_ = false, has_timed_out_ = false;
};

}  // namespace

DeployResult deploy(const Plan& plan, const Hardware& hardware, IoDevice& device,
                    const DeployOptions& options) {
  return Deployment(plan, hardware, device, options).run();
}

}  // namespace loopwright::hw
