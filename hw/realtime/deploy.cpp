#include "hw/realtime/deploy.h"
#include <fmt/format.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <semaphore>
#include "hw/realtime/control_loop.h"
#include "hw/realtime/last_words.h"
#include "hw/realtime/log_writer.h"
#include "hw/realtime/loop_end_text.h"
#include "hw/realtime/rescue.h"
#include "hw/realtime/stop_signals.h"
#include "hw/realtime/threads.h"

namespace loopwright::hw {
namespace {

using namespace std::chrono_literals;

/// Time that a run has to end after a signal; then the next signal ends the process.
constexpr int64_t longest_stop_ns = 2'000'000'000;
/// Time that the disk has to write the end of the log, unless a second request comes.
constexpr int64_t longest_wait_for_disk_ns = 60'000'000'000;

size_t rows_of_run(const Plan& plan, const Hardware& hardware) {
  return size_t((plan.stop_tick - plan.start_tick) / hardware.period_ticks + 1);
}
size_t rows_of_ring(const Plan& plan, const Hardware& hardware, size_t columns, size_t most_bytes) {
  const size_t most = std::max<size_t>(1, most_bytes / (columns * sizeof(double)));
  return std::clamp<size_t>(rows_of_run(plan, hardware), 1, most);
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
        ring_(std::make_shared<LogRing>(columns_.size(),
                                        rows_of_ring(plan, hardware, columns_.size(), options.ring_bytes))),
        loop_(plan, hardware, device, clock(), *ring_, columns_),
        last_words_(options.journal, device.description().watchdog.timeout > 0),
        has_sent_(device.outputs_safe() != OutputsSafe::untouched) {
    for (const LogColumn& column : columns_)
      result_.recording.columns.push_back({column.name, column.unit, {}});
    auto& facts = result_.recording.facts;
    facts.emplace_back("title", plan_.title);
    for (auto& fact : plan_.identity.facts()) facts.push_back(std::move(fact));
    facts.emplace_back("seed", fmt::format("{}", plan_.seed));
    facts.emplace_back("device", device_.description().path);
    for (const auto& [name, value] : plan_.parameters) facts.emplace_back("parameter " + name, value);
  }

  DeployResult run() {
    const StopSignals signals;
    const HandlerStack stack;
    SystemRequest request = options_.system;
    if (is_simulated_) request = {0, -1, false};  // there are no deadlines
    const RealTimeProcess process(request, result_.system);
    make_log();
    CrashGuard guard;
    guard.expect(has_sent_ ? LastWords::before_sampling() : LastWords::before_anything_is_sent());
    const int above = request.priority > 0 ? request.priority + 1 : 0;
    rescue_.emplace(device_, loop_, options_, hardware_.period_s, above);
    const GuardedThread watcher([&] { watch(signals, guard, above); }, [&] { is_over_ = true; });
    is_guarded_.acquire();  // a crash before that would leave the device open
    try {
      const GuardedThread loop([&] { run_loop(request); }, [&] { call_off(); });
      is_prepared_.acquire();
      if (set_up()) {
        tell_to(Begin::go);
        follow();
      }
    } catch (...) {
      fail(fmt::format("stopped by an exception: {}", text_of_exception()));
    }
    rescue_->begin_stop();
    {
      const DeviceUser::Use use(device_user_);
      device_.close();
    }
    is_closed_ = true;
    finish();
    return std::move(result_);
  }

 private:
  enum class Begin : uint8_t { waits, go, called_off };

  Clock& clock() {
    if (options_.clock) return *options_.clock;
    return is_simulated_ ? static_cast<Clock&>(simulated_clock_) : computer_clock_;
  }

  void make_log() {
    if (options_.journal.empty())
      sink_ = memory_ = std::make_shared<MemorySink>(
          result_.recording, options_.keeps_log ? options_.memory_bytes : 0, rows_of_run(plan_, hardware_));
    else
      sink_ = std::make_shared<JournalSink>(options_.journal, result_.recording);
    writer_ = std::make_unique<LogWriter>(ring_, sink_);
  }

  void tell_to(Begin what) {
    Begin waits = Begin::waits;
    begin_.compare_exchange_strong(waits, what);
    begin_.notify_all();
  }
  /// Ends the loop's thread in whatever state it is.
  void call_off() {
    tell_to(Begin::called_off);
    if (!has_ended_) rescue_->request_stop();
  }

  /// The real-time thread, from its scheduling to the safe outputs.
  void run_loop(const SystemRequest& request) noexcept {
    const HandlerStack stack;
    try {
      make_thread_real_time(request, result_.system);
      loop_.warm_up();
    } catch (...) {
      exception_in_loop_ = text_of_exception();
    }
    is_prepared_.release();
    begin_.wait(Begin::waits);
    if (begin_ == Begin::called_off) return;
    {
      const DeviceUser::Use use(device_user_);
      try {
        started_ = loop_.start();
        CrashGuard::expect(last_words_.while_sampling());
        if (started_.ok()) {
          if (options_.loop_begins) options_.loop_begins();
          loop_.run();
          if (options_.loop_ends) options_.loop_ends();
        }
      } catch (...) {
        exception_in_loop_ = text_of_exception();
      }
      rescue_->begin_stop();
      device_.stop();
      CrashGuard::expect(LastWords::after_the_stop());
    }
    has_ended_ = true;
    is_done_.release();
  }

  bool fail(std::string message, Status status = {}) {
    result_.status = RunStatus::failed;
    result_.message = std::move(message);
    result_.fault = status;
    return false;
  }

  /// Everything up to the first sample. False: canceled before anything moved.
  bool set_up() {
    if (!exception_in_loop_.empty()) return fail("the loop cannot be prepared: " + exception_in_loop_);
    if (options_.require_real_time && !is_simulated_ && !result_.system.all_granted())
      return fail("the system does not grant what a loop in real time needs:\n" + to_text(result_.system));
    const DeviceUser::Use use(device_user_);
    Status status = device_.open();
    result_.device = device_.facts();
    result_.device.push_back(fact_about_crashes());
    if (status.ok()) {
      tell_ready();
      has_sent_ = true, CrashGuard::expect(LastWords::before_sampling());
      status = device_.preset();
    }
    if (status.ok()) return true;
    const std::string what = device_.describe(status);
    rescue_->begin_stop();
    device_.stop();
    has_ended_ = true;
    return fail(fmt::format("{} cannot be set up: {}", device_.description().path, what), status);
  }

  void tell_ready() {
    if (!options_.ready) return;
    std::vector<std::string> lines = result_.device;
    for (const Granted& item : result_.system.items)
      lines.push_back(fmt::format("{}: {}", item.what, item.answer));
    options_.ready(lines);
  }

  std::string fact_about_crashes() const {
    const double timeout = device_.description().watchdog.timeout;
    const Capabilities can = device_.capabilities();
    const std::string watchdog =
        can.has_watchdog ? fmt::format("the device's watchdog puts them out after {:g} s", timeout)
                         : "there is no watchdog: nothing puts them out";
    return fmt::format("safe values after a crash of this program: {}; after kill -9 or a power cut {}",
                       can.is_reentrant   ? "sent by the driver"
                       : can.has_watchdog ? "tried by the driver, which is not re-entrant; else the watchdog"
                                          : "tried by the driver, which is not re-entrant",
                       watchdog);
  }

  // ---- the watcher: signals, calls that do not return, log failures, crashes ----
  // It calls no driver, unless the process crashes: whoever watches must not hang.

  void watch(const StopSignals& signals, CrashGuard& guard, int above) noexcept {
    const HandlerStack stack;
    // Above the loop, and above a thread of the rescue that hangs busily.
    raise_priority(above > 0 ? above + 1 : 0);
    guard.begin_guardian([](void* self) { return static_cast<Deployment*>(self)->stop_in_emergency(); },
                         this);
    is_guarded_.release();
    while (!is_over_) {
      if (const int signal = signals.wait(5, guard.descriptor())) take_signal(signal);
      if (CrashGuard::crashed_thread()) {
        guard.release(stop_in_emergency());
        for (;;) pause();  // the process ends
      }
      if (!has_ended_ && log_failure_ == 0 && (log_failure_ = writer_->failure()) != 0)
        rescue_->request_stop();
      rescue_->look(has_sent_ && !has_ended_);
      if (rescue_->is_overdue() && device_user_.is_used()) end_process(stop_signal_);
    }
    guard.end_guardian();
  }

  void take_signal(int signal) noexcept {
    ++signals_;
    if (int none = 0; stop_signal_.compare_exchange_strong(none, signal)) {
      asked_ns_ = wall_ns();
      rescue_->request_stop();
    } else if (!is_closed_ && wall_ns() - asked_ns_ > longest_stop_ns) {
      end_process(signal);
    }
  }

  /// Driver or callback hang and ignore the request: safe values within a second, unless the driver does not
  /// let them through, then the end; by the signal, if one asked for it.
  [[noreturn]] void end_process(int signal) noexcept {
    end_within(3);
    const bool is_in_motion = has_sent_ && !has_ended_;
    if (is_in_motion) rescue_->send_safe_values();
    const bool is_sent = is_in_motion && rescue_->have_been_sent(1000);
    writer_->wait_for_pass(200);
    CrashGuard::say_at_end("the run does not come to its end",
                           is_sent ? last_words_.of(OutputsSafe::unknown) : CrashGuard::expected());
    end_by(signal);
  }

  /// A thread has crashed and waits in its handler, or it is the caller itself, in the handler.
  const char* stop_in_emergency() noexcept {
    device_.emergency_stop();
    rescue_->request_stop();  // a loop that still runs stops the device itself
    OutputsSafe safe = has_sent_ ? OutputsSafe::unknown : OutputsSafe::untouched;
    if (device_user_.take_over(CrashGuard::crashed_thread(), CrashGuard::patience_ms / 2)) {
      device_.stop();
      device_.close();
      safe = device_.outputs_safe();
    }
    writer_->wait_for_pass(3 * LogWriter::every_ms);
    return last_words_.of(safe);
  }

  /// Shows the progress until the loop has ended.
  void follow() {
    for (int turn = 1; !is_done_.try_acquire_for(20ms); ++turn)
      if (options_.progress && turn % 10 == 0) options_.progress(loop_.live());
  }

  // ---- afterwards ----

  void finish() {
    result_.outputs_safe = device_.outputs_safe();
    result_.statistics = loop_.statistics();
    result_.time = loop_.stepper().run().now().time;
    if (result_.status == RunStatus::finished) explain_end();
    Facts facts{{"outputs_safe", std::string(to_name(result_.outputs_safe))}};
    if (result_.status != RunStatus::finished) facts.emplace_back("incomplete", result_.message);
    facts.emplace_back("rows",
                       fmt::format("{}", result_.statistics.cycles - result_.statistics.dropped_rows));
    require_known_outputs();
    end_log(facts);
    result_.statistics.longest_log_delay_s = writer_->longest_delay_s();
  }

  /// A motor may still be driven: that is no good end, even of a whole run.
  void require_known_outputs() {
    if (result_.outputs_safe != OutputsSafe::unknown) return;
    const char* what = "the device did not confirm its safe values: its outputs are not known";
    if (result_.status == RunStatus::finished)
      fail(what);
    else
      result_.message += fmt::format("\n{}", what);
  }

  /// The machine has stopped. The disk may take its time, but not without limit, and a second signal ends the
  /// wait.
  void end_log(const Facts& facts) {
    const int64_t begin = wall_ns();
    const int signals_before = signals_;
    const bool took_all = writer_->end(facts, [&] {
      const int64_t waited = wall_ns() - begin;
      return waited < longest_stop_ns || (signals_ == signals_before && waited < longest_wait_for_disk_ns);
    });
    if (took_all && memory_) {
      result_.recording = std::move(memory_->recording());
      result_.recording.facts.insert(result_.recording.facts.end(), facts.begin(), facts.end());
      if (options_.keeps_log) result_.statistics.dropped_rows += memory_->dropped();
    }
    if (took_all) return;
    const int error = writer_->failure();
    result_.log = error ? LogEnd::failed : LogEnd::stalled;
    result_.statistics.dropped_rows += int64_t(ring_->waiting());
    const std::string why = error ? std::strerror(error) : "the disk does not answer";
    const std::string what = fmt::format("the log could not be written to its end: {}", why);
    if (result_.status == RunStatus::finished)
      fail(what);
    else if (log_failure_ == 0)
      result_.message += "\n" + what;
  }

  void explain_end() {
    using Why = LoopEnd::Why;
    const LoopEnd& end = loop_.end();
    const auto at = fmt::format("at t = {:g} s", result_.time);
    if (!exception_in_loop_.empty()) {
      fail(fmt::format("an exception in the loop's thread: {}, {}", exception_in_loop_, at));
    } else if (!started_.ok()) {
      fail(fmt::format("the device does not start: {}", device_.describe(started_)), started_);
    } else if (const LoopPart hung = rescue_->hung(); hung != LoopPart::none) {
      fail(fmt::format("{}, {}", sentence_of(hung), at), {Code::device_fault});
    } else if (log_failure_ != 0 && end.why == Why::asked) {
      fail(fmt::format("the log cannot be written: {}; stopped {}", std::strerror(log_failure_), at));
    } else if (end.why == Why::asked) {
      result_.status = RunStatus::interrupted;
      result_.message = fmt::format("interrupted by {} {}", name_of_signal(stop_signal_), at);
    } else if (end.why == Why::status && end.status.code == Code::stopped) {
      fail("the device stopped sampling " + at, end.status);
    } else if (end.why == Why::status) {
      fail(fmt::format("{}, {}", device_.describe(end.status), at), end.status);
    } else if (end.why == Why::step_failed) {
      fail(loop_.stepper().fault());
    } else if (const std::string why =
                   policy_that_ended(end.why, result_.statistics, device_.description().policy, at);
               !why.empty()) {
      fail(why, end.status);
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
  std::shared_ptr<LogRing> ring_;
  std::shared_ptr<LogSink> sink_;
  std::shared_ptr<MemorySink> memory_;  // the same, if there is no journal
  std::unique_ptr<LogWriter> writer_;
  ControlLoop loop_;
  std::optional<Rescue> rescue_;  // its threads begin when signals are blocked
  DeployResult result_;
  Status started_;
  std::string exception_in_loop_;
  const LastWords last_words_;
  std::atomic<bool> has_sent_;
  DeviceUser device_user_;
  std::binary_semaphore is_prepared_{0}, is_done_{0}, is_guarded_{0};
  std::atomic<Begin> begin_ = Begin::waits;
  std::atomic<bool> has_ended_ = false, is_closed_ = false, is_over_ = false;
  std::atomic<int> stop_signal_ = 0, signals_ = 0, log_failure_ = 0;
  std::atomic<int64_t> asked_ns_ = 0;
};

}  // namespace

DeployResult deploy(const Plan& plan, const Hardware& hardware, IoDevice& device,
                    const DeployOptions& options) {
  return Deployment(plan, hardware, device, options).run();
}

}  // namespace loopwright::hw
