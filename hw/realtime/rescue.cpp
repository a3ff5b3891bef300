#include "hw/realtime/rescue.h"
#include <algorithm>
#include "models/real/whole.h"

namespace loopwright::hw {
namespace {

/// A start is a call of the vendor's library that may take its time.
constexpr int64_t longest_start_ns = 5'000'000'000;
/// Time that a read has to follow a request to stop.
constexpr int64_t longest_answer_ns = 100'000'000;
/// Time that a stop has until the safe values are sent from here as well.
constexpr int64_t longest_quiet_stop_ns = 2'000'000'000;

int64_t in_ns(double seconds) { return whole_between(1e9 * seconds, int64_t(0), INT64_MAX / 2); }

/// Time that a part of a cycle may take.
double longest_part(const IoDevice& device, const DeployOptions& options, double period_s) {
  if (options.read_timeout > 0) return options.read_timeout;
  return device.description().clock.time == Time::simulated ? 5 : std::max(0.25, 10 * period_s);
}

/// The calls of a stop in which a driver waits for a device that does not answer: two writes, the end of
/// sampling, the question to the watchdog.
constexpr double waits_of_a_stop = 4;

}  // namespace

Rescue::Rescue(IoDevice& device, ControlLoop& loop, const DeployOptions& options, double period_s,
               int priority)
    : device_(device),
      loop_(loop),
      longest_part_ns_(in_ns(longest_part(device, options, period_s))),
      longest_end_ns_(in_ns(options.end_timeout + waits_of_a_stop * device.capabilities().longest_wait)),
      ask_(device.call_of_request_stop(), priority),
      send_(device.call_of_emergency_stop(), priority) {}

void Rescue::request_stop() noexcept {
  int64_t never = 0;
  stop_since_ns_.compare_exchange_strong(never, wall_ns());
  loop_.request_stop();
  ask_.run();
}

void Rescue::send_safe_values() noexcept {
  device_.allow_only_safe_values();
  if (!is_sending_.exchange(true)) send_.run();
}

void Rescue::look(bool may_send) noexcept {
  const ControlLoop::Progress now = loop_.progress();
  const int64_t longest =
      now.part == LoopPart::start ? std::max(longest_part_ns_, longest_start_ns) : longest_part_ns_;
  bool needs_help = false;
  if (now.part != LoopPart::none && now.for_ns > longest) {
    if (hung_ == LoopPart::none) hung_ = now.part, request_stop();
    // A read returns when it is asked to; nothing wakes the other calls, and meanwhile the last command
    // stands.
    needs_help = now.part != LoopPart::read || now.for_ns > longest + longest_answer_ns;
  }
  const int64_t since = stop_since_ns_;
  needs_help |= since != 0 && wall_ns() - since > longest_quiet_stop_ns;
  if (needs_help && may_send) send_safe_values();
}

bool Rescue::is_overdue() const noexcept {
  const int64_t since = stop_since_ns_;
  return since != 0 && wall_ns() - since > longest_end_ns_;
}

const char* sentence_of(LoopPart hung) noexcept {
  switch (hung) {
    case LoopPart::none:
      break;
    case LoopPart::start:
      return "the start of the device did not return";
    case LoopPart::read:
      return "a read of the device did not return";
    case LoopPart::step:
      return "a step of the diagram did not return";
    case LoopPart::write:
      return "a write to the device did not return";
  }
  return "";
}

}  // namespace loopwright::hw
