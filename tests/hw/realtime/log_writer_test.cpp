// The log between the loop and the disk: in order, in time, and without blocking the loop.
#include "hw/realtime/log_writer.h"
#include <gtest/gtest.h>
#include <cerrno>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::hw::log_writer_test {
namespace {

using namespace std::chrono_literals;

/// A disk that stalls and fails on request.
class TestSink final : public LogSink {
 public:
  int take(std::span<const double> rows, int64_t dropped) override {
    std::unique_lock lock(mutex_);
    condition_.wait(lock, [&] { return !is_stalled; });
    if (error) return error;
    taken.insert(taken.end(), rows.begin(), rows.end());
    last_dropped = dropped;
    return 0;
  }
  int end(const Facts& facts, int64_t) override { return ended_with = facts, 0; }
  void stall(bool on) {
    const std::lock_guard lock(mutex_);
    is_stalled = on;
    condition_.notify_all();
  }
  std::vector<double> taken;
  int64_t last_dropped = 0;
  Facts ended_with;
  std::atomic<int> error = 0;

 private:
  bool is_stalled = false;
  std::mutex mutex_;
  std::condition_variable condition_;
};

void push(LogRing& ring, int from, int to) {
  for (int i = from; i < to; ++i) ring.push(std::array{double(i), 2.0 * i});
}

TEST(LogWriter, HandsEverythingOverInOrderAndEndsWithTheFacts) {
  const auto ring = std::make_shared<LogRing>(2, 100'000);
  const auto sink = std::make_shared<TestSink>();
  LogWriter writer(ring, sink);
  push(*ring, 0, 60'000);
  EXPECT_TRUE(writer.end({{"outputs_safe", "confirmed"}}, [] { return true; }));
  ASSERT_EQ(sink->taken.size(), 120'000u);
  for (int i = 0; i < 60'000; ++i) ASSERT_EQ(sink->taken[2 * size_t(i)], i);
  EXPECT_EQ(sink->ended_with.at(0).second, "confirmed");
}

TEST(LogWriter, WithoutBeingAskedARowIsHandedOverWithinAFractionOfASecond) {
  const auto ring = std::make_shared<LogRing>(2, 1000);
  const auto sink = std::make_shared<TestSink>();
  LogWriter writer(ring, sink);
  push(*ring, 0, 10);
  writer.wait_for_pass(2000);
  EXPECT_EQ(ring->waiting(), 0u);
  EXPECT_TRUE(writer.end({}, [] { return true; }));
  EXPECT_EQ(sink->taken.size(), 20u);
}

TEST(LogWriter, AStalledDiskHoldsUpNobodyAndLosesOnlyWhatHasNoRoom) {
  const auto ring = std::make_shared<LogRing>(2, 1000);
  const auto sink = std::make_shared<TestSink>();
  LogWriter writer(ring, sink);
  sink->stall(true);
  push(*ring, 0, 1);
  std::this_thread::sleep_for(200ms);  // the writer hangs with it
  const auto begin = std::chrono::steady_clock::now();
  push(*ring, 1, 3001);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 100ms);
  EXPECT_GE(ring->drops(), 1999);
  sink->stall(false);
  EXPECT_TRUE(writer.end({}, [] { return true; }));
  EXPECT_EQ(int64_t(sink->taken.size()) / 2 + ring->drops(), 3001);
  EXPECT_EQ(sink->last_dropped, ring->drops());
  EXPECT_GT(writer.longest_delay_s(), 0.15);
}

TEST(LogWriter, ADiskThatNeverAnswersIsGivenUp) {
  const auto ring = std::make_shared<LogRing>(2, 1000);
  const auto sink = std::make_shared<TestSink>();
  sink->stall(true);
  {
    LogWriter writer(ring, sink);
    push(*ring, 0, 10);
    int patience = 20;
    EXPECT_FALSE(writer.end({}, [&] { return --patience > 0; }));
    EXPECT_EQ(writer.failure(), 0);
  }
  sink->stall(false);  // the abandoned thread ends
  std::this_thread::sleep_for(100ms);
}

TEST(LogWriter, AFullDiskIsTold) {
  const auto ring = std::make_shared<LogRing>(2, 1000);
  const auto sink = std::make_shared<TestSink>();
  sink->error = ENOSPC;
  LogWriter writer(ring, sink);
  push(*ring, 0, 10);
  writer.wait_for_pass(2000);
  EXPECT_EQ(writer.failure(), ENOSPC);
  EXPECT_FALSE(writer.end({}, [] { return true; }));
  EXPECT_TRUE(sink->ended_with.empty());
}

TEST(LogWriter, AJournalRepeatsItsHeading) {
  const DiagramFolder folder;
  const auto ring = std::make_shared<LogRing>(1, 10);
  const Recording heading{{{"time", "s", {}}}, {}};
  JournalSink sink(folder.path("j"), heading);
  for (int i = 0; i < 1500; ++i) ASSERT_EQ(sink.take(std::array{double(i)}, 0), 0);
  ASSERT_EQ(sink.end({}, 0), 0);
  // If the first heading is damaged, the rest is still read.
  std::fstream file(folder.path("j"), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(60), file.put(char(99)), file.close();
  const JournalReader journal(folder.path("j"));
  EXPECT_GE(journal.survey().rows, 400);
  EXPECT_EQ(journal.survey().rows + journal.survey().lost_rows, 1500);
}

}  // namespace
}  // namespace loopwright::hw::log_writer_test
