/// Sweeps that are killed, whose disk is full, damaged or read-only, and two sweeps that write to one folder.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <fstream>
#include "models/random/philox.h"
#include "tests/tools/sweep/sweep_testing.h"

namespace loopwright::interruption_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// The exception of the sweep; empty: none.
std::string failure_of(const SweepPlan& plan, const std::string& folder, const SweepOptions& options = {}) {
  try {
    run_sweep(plan, folder, options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// A child that sweeps and reports how many runs it has completed.
struct KilledSweep {
  int64_t acknowledged = 0;
  bool was_killed = false;
};
KilledSweep sweep_killed_after(useconds_t microseconds, const SweepPlan& plan, const std::string& folder) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    SweepOptions options;
    options.resume = fs::exists(folder);
    options.instruction_set = InstructionSet::scalar;
    options.progress = [&](int64_t done, int64_t) {
      [[maybe_unused]] const auto written = ::write(pipe_ends[1], &done, sizeof done);
    };
    run_sweep(plan, folder, options);
    _exit(0);
  }
  close(pipe_ends[1]);
  usleep(microseconds);
  kill(child, SIGKILL);
  KilledSweep result;
  int status = 0;
  waitpid(child, &status, 0);
  while (::read(pipe_ends[0], &result.acknowledged, sizeof result.acknowledged) ==
         ssize_t(sizeof result.acknowledged)) {
  }
  close(pipe_ends[0]);
  result.was_killed = WIFSIGNALED(status);
  return result;
}

TEST(Interruption, LosesNothingWhenItIsKilledAtFiftyRandomMoments) {
  const SweepFolder folder(four_axis_values, R"(, "samples": {"method": "latin_hypercube", "count": 160})");
  const SweepPlan plan = folder.plan();
  const auto start = std::chrono::steady_clock::now();
  const auto whole = bits_with(plan, folder, "whole", {.instruction_set = InstructionSet::scalar});
  const std::chrono::duration<double, std::micro> duration = std::chrono::steady_clock::now() - start;
  int kills = 0, sweeps = 0;
  for (uint64_t attempt = 0; kills < 50 && attempt < 500; ++attempt) {
    const double moment = uniform_pair(1, 0, attempt).first;
    const KilledSweep killed =
        sweep_killed_after(useconds_t(moment * duration.count()), plan, folder.results());
    kills += killed.was_killed;
    if (!fs::exists(folder.results())) continue;
    const SweepResults results = read_results(plan, folder.results());
    EXPECT_GE(int64_t(results.table.rows()), killed.acknowledged);
    if (results.missing > 0) continue;
    EXPECT_EQ(bits_of(results.table), whole);
    fs::remove_all(folder.results());
    ++sweeps;
  }
  EXPECT_EQ(kills, 50);
  EXPECT_EQ(bits_with(plan, folder, "results", {}), whole) << "after " << sweeps << " whole sweeps";
}

TEST(Interruption, MakesDamagedAndTornRunsAgain) {
  const SweepFolder folder(R"("mass.mass": {"linear": {"from": 0.5, "to": 2, "count": 40}})");
  const SweepPlan plan = folder.plan();
  const auto whole = bits_with(plan, folder, "whole", {});
  const std::string shard = shard_files(folder.results("whole"))[0];
  std::ifstream file(shard, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  fs::create_directories(folder.results("damaged"));
  const std::string copy = folder.results("damaged") + "/" + fs::path(shard).filename().string();
  for (size_t at = 50; at < bytes.size(); at += 97) {
    std::string damaged = bytes;
    damaged[at] = char(damaged[at] ^ (1 << at % 8));
    if (at % 2) damaged.resize(at);
    std::ofstream(copy, std::ios::binary) << damaged;
    const SweepResults before = read_results(plan, folder.results("damaged"));
    EXPECT_GE(before.missing, 1) << at;
    EXPECT_FALSE(before.notes.empty()) << at;
    EXPECT_EQ(bits_with(plan, folder, "damaged", {}), whole) << at;
  }
}

TEST(Interruption, RefusesASecondWriterAndForeignResults) {
  const SweepFolder folder(R"("mass.mass": {"values": [1, 2]})"), other(R"("mass.mass": {"values": [1, 3]})");
  const SweepPlan plan = folder.plan();
  run_sweep(plan, folder.results(), {});
  EXPECT_THAT(failure_of(plan, folder.results()), HasSubstr("--resume"));
  EXPECT_THAT(failure_of(other.plan(), folder.results(), {.resume = true}),
              HasSubstr("belongs to another sweep"));
  const ShardWriter writer(shard_files(folder.results())[0], plan.hash(), plan.sweep().metrics.size());
  EXPECT_THAT(failure_of(plan, folder.results(), {.resume = true}),
              HasSubstr("another sweep is writing here"));
}

constexpr const char* played_loop = R"json({
  "loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 0.5},
  "blocks": {"track": {"type": "RecordedColumn", "file": "track.csv", "column": "x"},
             "gain": {"type": "Gain", "gain": 1, "in": {"u": "track.value"}}},
  "log": ["gain.y"]})json";

TEST(Interruption, RefusesToGoOnWithOtherContentsOfAFile) {
  SweepFolder folder(R"("gain.gain": {"values": [1, 2, 3]})", "", R"("a": {"final": "gain.y"})", played_loop);
  folder.folder.with("track.csv", "time,x\n0,1\n1,1\n");
  run_sweep(folder.plan(), folder.results(), {});
  folder.folder.with("track.csv", "time,x\n0,1\n1,2\n");
  const SweepPlan changed = folder.plan();
  const auto names_it = HasSubstr("belongs to another sweep: the file \"track.csv\" has changed");
  EXPECT_THAT(failure_of(changed, folder.results(), {.resume = true}), names_it);
  EXPECT_THAT(failure_of(changed, folder.results(), {.shard = 1, .shards = 2}), names_it)
      << "another part of it";
  try {
    read_results(changed, folder.results());
    ADD_FAILURE() << "tables of other data";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), names_it);
  }
  folder.folder.with("track.csv", "time,x\n0,1\n1,1\n");
  EXPECT_EQ(failure_of(folder.plan(), folder.results(), {.resume = true}), "");
}

TEST(Interruption, SaysWhenNoMoreCanBeWrittenAndKeepsWhatWasWritten) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto ignored = signal(SIGXFSZ, SIG_IGN);
  const rlimit small{10'000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = failure_of(plan, folder.results());
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, ignored);
  EXPECT_THAT(message, HasSubstr("cannot be written"));
  const SweepResults kept = read_results(plan, folder.results());
  EXPECT_GT(kept.table.rows(), 50u);
  EXPECT_TRUE(kept.notes.empty());  // no incomplete file remains
  EXPECT_EQ(bits_with(plan, folder, "results", {}).size(), 160 * kept.table.columns.size());
}

/// A separate disk of any size; null if mounting is not allowed.
class SmallDisk {
 public:
  static std::unique_ptr<SmallDisk> mounted(const std::string& at, const std::string& size) {
    fs::create_directories(at);
    if (mount("tmpfs", at.c_str(), "tmpfs", 0, ("size=" + size).c_str()) != 0) return nullptr;
    return std::unique_ptr<SmallDisk>(new SmallDisk(at));
  }
  ~SmallDisk() { umount2(at_.c_str(), MNT_DETACH); }
  bool grow(const std::string& size) const {
    return mount("tmpfs", at_.c_str(), "tmpfs", MS_REMOUNT, ("size=" + size).c_str()) == 0;
  }

 private:
  explicit SmallDisk(std::string at) : at_(std::move(at)) {}
  std::string at_;
};

TEST(Interruption, GoesOnWhenTheFullDiskHasRoomAgain) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  const auto whole = bits_with(plan, folder, "whole", {});
  const auto disk = SmallDisk::mounted(folder.results(), "16k");  // four pages; a record has 130 bytes
  if (!disk) GTEST_SKIP() << "mounting a small disk is not allowed here";
  EXPECT_THAT(failure_of(plan, folder.results()), HasSubstr("No space left on device"));
  const SweepResults kept = read_results(plan, folder.results());
  EXPECT_GT(kept.table.rows(), 0u);
  EXPECT_GT(kept.missing, 0);
  EXPECT_TRUE(kept.notes.empty());  // no incomplete file remains
  ASSERT_TRUE(disk->grow("4m"));
  EXPECT_EQ(bits_with(plan, folder, "results", {}), whole);
}

/// Drops the rights of root while it exists, if possible: root may write everywhere.
struct WithoutRights {
  WithoutRights() : is_root(geteuid() == 0) {
    if (is_root) is_dropped = seteuid(65534) == 0;
  }
  ~WithoutRights() {
    if (is_root && is_dropped && seteuid(0) != 0) std::abort();
  }
  const bool is_root;
  bool is_dropped = false;
};

TEST(Interruption, RefusesAFolderThatCannotBeWrittenBeforeItRunsAnything) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  fs::create_directories(folder.results("closed"));
  fs::permissions(folder.folder.path("."), fs::perms(0755));
  fs::permissions(folder.results("closed"), fs::perms(0555));
  bool has_run = false;
  SweepOptions options;
  options.progress = [&](int64_t, int64_t) { has_run = true; };
  std::string existing, nested;
  {
    const WithoutRights nobody;
    if (nobody.is_root && !nobody.is_dropped)
      GTEST_SKIP() << "root that cannot be anybody else writes everywhere";
    existing = failure_of(plan, folder.results("closed"), options);
    nested = failure_of(plan, folder.results("closed/below"), options);
  }
  for (const std::string& message : {existing, nested}) {
    EXPECT_THAT(message, HasSubstr("/closed"));
    EXPECT_THAT(message, HasSubstr("Permission denied"));
  }
  EXPECT_FALSE(has_run);
  EXPECT_TRUE(fs::is_empty(folder.results("closed")));
}

}  // namespace
}  // namespace loopwright::interruption_test
