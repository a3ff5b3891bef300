/// Moves rows from the loop's ring to their destination, in threads of its own.
///
/// One thread passes on the rows in the ring every `every_ms`; another flushes them to the disk once a
/// second. So a slow disk delays neither the loop nor the rows that survive a kill -9. If the disk stalls,
/// the ring fills, and further rows are dropped and counted. If the disk fails, writing ends, and failure()
/// states why.
#pragma once
#include <atomic>
#include <memory>
#include "hw/realtime/log_ring.h"
#include "hw/realtime/log_sink.h"

namespace loopwright::hw {

class LogWriter {
 public:
  static constexpr int every_ms = 50;
  static constexpr int sync_every_ms = 1000;

  LogWriter(std::shared_ptr<LogRing> ring, std::shared_ptr<LogSink> sink);
  /// Abandons a log that was not ended: a thread that hangs on a stalled disk is detached.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// errno of the first failure; 0: none.
  int failure() const noexcept;
  /// Waits until all rows now in the ring were passed on, at most this long. Calls nothing that allocates.
  void wait_for_pass(int milliseconds) const noexcept;
  /// Writes the rows left in the ring, then `facts`, and flushes to the disk. Waits as long as `patience`
  /// returns true. False: the disk did not accept everything.
  bool end(const Facts& facts, const std::function<bool()>& patience);
  /// [s] longest time that a row spent in the ring before it was passed on.
  double longest_delay_s() const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace loopwright::hw
