/// Brings a stop to its end although the driver hangs: notices calls that do not return, and asks for the end
/// and sends safe values in threads of their own. The thread that watches is never in the driver, whose
/// library may hang with its lock held.
#pragma once
#include "hw/realtime/control_loop.h"
#include "hw/realtime/detached_call.h"

namespace loopwright::hw {

class Rescue {
 public:
  /// `priority` of its threads, above the loop's. Throws if there are no threads.
  Rescue(IoDevice& device, ControlLoop& loop, const DeployOptions& options, double period_s, int priority);

  /// From any thread; returns at once.
  void request_stop() noexcept;
  /// The stop, or a further step of it, begins now: from here its time is measured.
  void begin_stop() noexcept { stop_since_ns_ = wall_ns(); }
  /// Asks another thread to send the safe values, and from now on no other values are sent; returns at once.
  void send_safe_values() noexcept;
  /// Waits at most this long until they are sent. False: the driver has not returned, or nothing was asked
  /// for.
  bool have_been_sent(int milliseconds) const noexcept { return is_sending_ && send_.wait(milliseconds); }

  /// Called a hundred times a second or more, by the thread that watches. `may_send`: the device has been set
  /// up, and its stop has not come to an end.
  void look(bool may_send) noexcept;
  /// The part of the loop that did not return in time; none: all did.
  LoopPart hung() const noexcept { return hung_; }
  /// A stop was begun, and should have come to its end long ago.
  bool is_overdue() const noexcept;

 private:
  IoDevice& device_;
  ControlLoop& loop_;
  const int64_t longest_part_ns_, longest_end_ns_;
  DetachedCall ask_, send_;
  std::atomic<LoopPart> hung_ = LoopPart::none;
  std::atomic<int64_t> stop_since_ns_ = 0;  // 0: no stop was asked for
  std::atomic<bool> is_sending_ = false;
};

/// "a read of the device did not return"
const char* sentence_of(LoopPart hung) noexcept;

}  // namespace loopwright::hw
