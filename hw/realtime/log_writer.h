/// Carries rows from the loop's ring to where they are kept, in threads of its own.
///
/// One thread hands over what the ring holds every `every_ms`; another brings it to the disk once a second,
/// so that a slow disk holds up neither the loop nor what a kill -9 leaves. A disk that stalls fills the
/// ring, whose rows are then dropped and counted; one that fails ends the writing, and failure() says why.
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
  /// Gives up what was not ended: a thread that hangs in a stalled disk is left to itself.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// errno of the first failure; 0: none.
  int failure() const noexcept;
  /// Waits until all that stood in the ring was handed over, at most so long. Calls nothing that allocates.
  void wait_for_pass(int milliseconds) const noexcept;
  /// Rows still in the ring, then `facts`, then on to the disk. Waits as long as `patience` answers true;
  /// false: the disk did not take everything.
  bool end(const Facts& facts, const std::function<bool()>& patience);
  /// [s] the longest time for which a row stood in the ring before it was handed over.
  double longest_delay_s() const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace loopwright::hw
