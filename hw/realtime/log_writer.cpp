#include "hw/realtime/log_writer.h"
#include <cerrno>
#include <chrono>
#include <ctime>
#include <semaphore>
#include <thread>
#include "hw/realtime/clock.h"
#include "hw/realtime/crash_guard.h"

namespace loopwright::hw {

using namespace std::chrono_literals;

/// Outlives the writer if a thread hangs.
struct LogWriter::Shared {
  std::shared_ptr<LogRing> ring;
  std::shared_ptr<LogSink> sink;
  std::vector<double> rows;  // of one chunk
  Facts facts;               // set before is_ending
  std::atomic<int> failure = 0;
  std::atomic<int64_t> passes = 0, longest_delay_ns = 0;
  std::atomic<bool> is_ending = false, is_over = false;
  std::binary_semaphore ends{0}, ended{0}, sync_ends{0}, sync_ended{0};

  void fail(int error) noexcept {
    int none = 0;
    if (error) failure.compare_exchange_strong(none, error);
  }
  /// Passes on all rows in the ring, in chunks.
  void pass() {
    const auto hand_over = [&] {
      if (!rows.empty() && failure == 0) fail(sink->take(rows, ring->drops()));
      rows.clear();
    };
    ring->drain([&](std::span<const double> row) {
      if (rows.size() + row.size() > rows.capacity()) hand_over();
      rows.insert(rows.end(), row.begin(), row.end());
    });
    hand_over();
  }
  void write() noexcept try {
    const HandlerStack stack;
    for (int64_t last = wall_ns(); !is_ending;) {
      ends.try_acquire_for(std::chrono::milliseconds(LogWriter::every_ms));
      pass();
      const int64_t now = wall_ns();
      if (now - last > longest_delay_ns) longest_delay_ns = now - last;
      last = now;
      passes.fetch_add(1);
    }
    pass();
    if (failure == 0) fail(sink->end(facts, ring->drops()));
    is_over = true;
    ended.release();
  } catch (...) {
    fail(ENOMEM), is_over = true;
    ended.release();
  }
  void sync() noexcept {
    const HandlerStack stack;
    while (!sync_ends.try_acquire_for(std::chrono::milliseconds(LogWriter::sync_every_ms)))
      if (failure == 0) fail(sink->sync());
    sync_ended.release();
  }
};

LogWriter::LogWriter(std::shared_ptr<LogRing> ring, std::shared_ptr<LogSink> sink)
    : shared_(std::make_shared<Shared>()) {
  constexpr size_t most_numbers =
      (256 << 10) / sizeof(double);  // of a chunk; its rows are lost together if it is damaged
  shared_->rows.reserve(std::max(most_numbers, ring->columns()));
  shared_->ring = std::move(ring), shared_->sink = std::move(sink);
  std::thread([shared = shared_] { shared->write(); }).detach();
  try {
    std::thread([shared = shared_] { shared->sync(); }).detach();
  } catch (...) {
    shared_->is_ending = true, shared_->ends.release();
    shared_->ended.acquire();
    throw;
  }
}

LogWriter::~LogWriter() {
  if (!shared_->is_ending.exchange(true)) shared_->ends.release(), shared_->sync_ends.release();
  shared_->ended.try_acquire_for(100ms), shared_->sync_ended.try_acquire_for(100ms);
}

int LogWriter::failure() const noexcept { return shared_->failure; }
double LogWriter::longest_delay_s() const noexcept { return 1e-9 * double(shared_->longest_delay_ns); }

void LogWriter::wait_for_pass(int milliseconds) const noexcept {
  const int64_t wanted = shared_->passes + 2;  // the first pass may have begun earlier
  const timespec moment = {0, 1'000'000};
  for (int i = 0; i < milliseconds && shared_->passes < wanted && !shared_->is_over; ++i)
    nanosleep(&moment, nullptr);
}

bool LogWriter::end(const Facts& facts, const std::function<bool()>& patience) {
  Shared& shared = *shared_;
  shared.facts = facts;
  shared.is_ending = true;
  shared.ends.release(), shared.sync_ends.release();
  while (!shared.ended.try_acquire_for(10ms))
    if (!patience()) return false;
  shared.ended.release();
  return shared.failure == 0;
}

}  // namespace loopwright::hw
