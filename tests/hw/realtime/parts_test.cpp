// The small parts of the loop: ring buffer of the log, histogram, what the system grants, messages of
// crashes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <csignal>
#include <thread>
#include "engine/record/journal.h"
#include "hw/realtime/crash_guard.h"
#include "hw/realtime/histogram.h"
#include "hw/realtime/last_words.h"
#include "hw/realtime/log_ring.h"
#include "hw/realtime/system.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::hw::parts_test {
namespace {

TEST(LogRing, RowsComeOutInOrderAndARowWithoutRoomIsCounted) {
  LogRing ring(2, 3);
  for (int i = 0; i < 5; ++i) ring.push(std::array{double(i), 10.0 * i});
  EXPECT_EQ(ring.drops(), 2);
  std::vector<double> seen;
  ring.drain([&](std::span<const double> row) { seen.insert(seen.end(), row.begin(), row.end()); });
  EXPECT_EQ(seen, (std::vector<double>{0, 0, 1, 10, 2, 20}));
  ring.push(std::array{7.0, 70.0});
  ring.drain([&](std::span<const double> row) { EXPECT_EQ(row[1], 70); });
}

TEST(LogRing, NothingIsLostOrTornBetweenThreads) {
  constexpr int rows = 200000;
  LogRing ring(3, 1024);
  std::thread writer([&] {
    for (int i = 0; i < rows; ++i) ring.push(std::array{double(i), double(i), double(i)});
  });
  int64_t count = 0;
  double last = -1;
  const auto take = [&](std::span<const double> row) {
    ASSERT_TRUE(row[0] == row[1] && row[1] == row[2] && row[0] > last);
    last = row[0], ++count;
  };
  while (count + ring.drops() < rows) ring.drain(take);
  writer.join();
  EXPECT_EQ(count + ring.drops(), rows);
}

TEST(Histogram, CountsMicrosecondsAndKeepsTheLongestWithItsCycle) {
  Histogram histogram;
  for (int i = 0; i < 98; ++i) histogram.add(2500, i);
  histogram.add(7999, 98);
  histogram.add(5'000'000, 99);
  EXPECT_EQ(histogram.in_bin(2), 98);
  EXPECT_EQ(histogram.in_bin(7), 1);
  EXPECT_EQ(histogram.beyond(), 1);
  EXPECT_EQ(histogram.longest_ns(), 5'000'000);
  EXPECT_EQ(histogram.longest_cycle(), 99);
  EXPECT_EQ(histogram.quantile_us(0.5), 3);
  EXPECT_EQ(histogram.quantile_us(0.99), 8);
  EXPECT_EQ(histogram.quantile_us(1), 5000) << "beyond the bins the longest stands for all";
}

TEST(System, WhatWasAskedForIsToldItemByItem) {
  SystemReport report;
  {
    const RealTimeProcess process({0, -1, true}, report);
    std::thread([&] { make_thread_real_time({80, 1000, true}, report); }).join();
  }
  std::string text = to_text(report);
  for (const char* item :
       {"real-time kernel", "memory locked", "processor kept awake", "SCHED_FIFO 80", "processor 1000 only"})
    EXPECT_NE(text.find(item), text.npos) << item;
  EXPECT_FALSE(report.all_granted()) << "there is no processor 1000";
}

TEST(LastWords, NameTheJournalOnlyWhileItIsThere) {
  const DiagramFolder folder;
  const std::string path = folder.path("log.csv.journal");
  const LastWords words(path, true);
  const std::string recover = "loopwright recover " + path;
  EXPECT_THAT(words.of(OutputsSafe::confirmed), testing::Not(testing::HasSubstr("recover")));
  const JournalWriter journal(path, {{{"time", "s", {}}}, {}});
  EXPECT_THAT(words.of(OutputsSafe::confirmed), testing::HasSubstr(recover));
  std::filesystem::resize_file(path, 0);
  EXPECT_THAT(words.of(OutputsSafe::confirmed), testing::Not(testing::HasSubstr("recover")));
  EXPECT_THAT(words.of(OutputsSafe::untouched), testing::StartsWith("nothing was sent to the device"));
}

TEST(LastWords, LeaveNothingToAWatchdogThatIsNotArmed) {
  const LastWords with("", true), without("", false);
  EXPECT_THAT(with.while_sampling(), testing::HasSubstr("only the device's watchdog"));
  EXPECT_THAT(without.while_sampling(), testing::HasSubstr("there is no watchdog"));
  EXPECT_THAT(with.before_sampling(), testing::HasSubstr("watchdog is not armed"));
  EXPECT_THAT(with.before_anything_is_sent(), testing::HasSubstr("nothing was sent"));
}

/// Crashes while a guardian does not answer; without one if `words` is empty.
void crash(const char* words) {
  CrashGuard guard;
  std::atomic<bool> begun = *words == 0;
  std::thread guardian([&] {
    if (!begun) guard.begin_guardian([](void*) { return ""; }, nullptr);
    begun = true;
    for (;;) pause();
  });
  while (!begun) std::this_thread::yield();
  CrashGuard::expect(words);
  raise(SIGABRT);
}

TEST(CrashMessage, SaysInWhichStateTheDeviceIs) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  setenv("ASAN_OPTIONS", "handle_abort=0:detect_leaks=0", 1);
  EXPECT_EXIT(crash(""), testing::KilledBySignal(SIGABRT), "loopwright: SIGABRT: the device is not open");
  EXPECT_EXIT(crash("it was not started"), testing::KilledBySignal(SIGABRT),
              "loopwright: SIGABRT: it was not started");
}

}  // namespace
}  // namespace loopwright::hw::parts_test
