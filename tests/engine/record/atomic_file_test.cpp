#include "engine/record/atomic_file.h"

#include <gmock/gmock.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <fstream>
#include <functional>

#include "engine/record/csv.h"
#include "engine/record/mat.h"
#include "support.h"

namespace loopwright::atomic_file_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(AtomicFile, AppearsOnlyWithCommit) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("one ");
    file.write("two");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    file.commit();
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "one two");
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWhenItIsAbandoned) {
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "old");
  {
    AtomicFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.count_files(), 1u);
}

/// The number of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(AtomicFile, RemovesWhatAKilledProgramLeftBesideTheTarget) {
  const TemporaryFolder folder;
  const std::string gone = std::to_string(ended_process()), here = std::to_string(::getpid());
  const auto make = [&](const std::string& name) { std::ofstream(folder / name) << "half"; };
  make(".a.csv." + gone + "-0");
  make(".a.csv." + gone + "-17");
  const std::vector<std::string> kept = {".a.csv." + here + "-99", ".b.csv." + gone + "-0", ".a.csv." + gone,
                                         ".a.csv." + gone + "-0x", ".a.csv.bak." + gone + "-0"};
  for (const std::string& name : kept) make(name);
  write_file(folder / "a.csv", "whole");
  EXPECT_EQ(bytes_of(folder / "a.csv"), "whole");
  for (const std::string& name : kept) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  EXPECT_EQ(folder.count_files(), kept.size() + 1);
}

TEST(AtomicFile, KeepsWhatIsStillBeingWrittenThoughItsProcessCannotBeSeen) {
  const TemporaryFolder folder;  // as from another machine, on a shared folder
  const std::string other = folder / (".a.csv." + std::to_string(ended_process()) + "-0");
  std::ofstream(other) << "half";
  const int writer = ::open(other.c_str(), O_WRONLY);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  write_file(folder / "a.csv", "whole");
  EXPECT_TRUE(std::filesystem::exists(other));
  ::close(writer);
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "old");
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0640), 0);
  ASSERT_EQ(::symlink("a.txt", (folder / "link").c_str()), 0);
  write_file(folder / "link", "new");
  struct stat status;
  ASSERT_EQ(::lstat((folder / "link").c_str(), &status), 0);
  EXPECT_TRUE(S_ISLNK(status.st_mode));
  ASSERT_EQ(::stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(bytes_of(folder / "a.txt"), "new");
}

TEST(AtomicFile, NamesThePathAndTheReasonOfAFailure) {
  const TemporaryFolder folder;
  const auto failure = [](const std::string& path, const std::string& reason) {
    EXPECT_THAT([&] { write_file(path, "text"); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr(reason))));
  };
  failure(folder / "missing/a.txt", "does not exist");
  failure(folder / ".", "it is a folder");
  failure("/dev/full", "No space left");
  failure("", "cannot write");
}

TEST(AtomicFile, RespectsFoldersAndFilesThatAreProtected) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "old");
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0400), 0);
  EXPECT_THROW(write_file(folder / "a.txt", "new"), std::runtime_error);
  ASSERT_EQ(::chmod((folder / "").c_str(), 0500), 0);
  EXPECT_THROW(write_file(folder / "b.txt", "new"), std::runtime_error);
  ASSERT_EQ(::chmod((folder / "").c_str(), 0700), 0);
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(AtomicFile, WritesThroughToDevices) {
  write_file("/dev/null", "text");
  struct stat status;
  ASSERT_EQ(::stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode)) << "a device must not be replaced by a file";
}

/// Runs `write` in a process whose files are limited to `bytes`, as on a full disk. True if it threw.
bool throws_on_full_disk(rlim_t bytes, const std::function<void()>& write) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 0;
    try {
      write();
    } catch (const std::runtime_error&) {
      code = 7;
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 7;
}

TEST(AtomicFile, LeavesNothingHalfWrittenOnAFullDisk) {
  const TemporaryFolder folder;
  Recording recording{{{"x", "", {}}}, {}};
  std::mt19937_64 random(7);
  while (recording.rows() < 200'000) recording.columns[0].values.push_back(any_finite(random));
  for (const rlim_t size : {rlim_t{0}, rlim_t{1000}, rlim_t{1'200'000}}) {
    EXPECT_TRUE(throws_on_full_disk(size, [&] { write_csv(folder / "a.csv", recording); })) << size;
    EXPECT_TRUE(throws_on_full_disk(size, [&] { write_mat(folder / "a.mat", recording); })) << size;
    EXPECT_EQ(folder.count_files(), 0u);
  }
}

}  // namespace
}  // namespace loopwright::atomic_file_test
