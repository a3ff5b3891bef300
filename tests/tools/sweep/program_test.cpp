/// The program itself: exit codes, its pages and tables, several processes of one mpirun.
#include <gmock/gmock.h>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include "tests/tools/sweep/sweep_testing.h"
#include "where.h"

namespace loopwright::program_test {
namespace {

using ::testing::HasSubstr;

const std::string program = LOOPWRIGHT_PROGRAM;

int exit_code(const std::string& command) {
  const int status = std::system((command + " >/dev/null 2>&1").c_str());
  return WEXITSTATUS(status);
}
std::string content(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

const std::string four_ranks =
    "ASAN_OPTIONS=detect_leaks=0 timeout 120 mpirun --allow-run-as-root --oversubscribe -n 4";
const char* const two_hundred_runs = R"("mass.mass": {"linear": {"from": 0.5, "to": 2, "count": 200}})";

TEST(SweepProgram, LeavesTablesAPageAndTraces) {
  const SweepFolder folder(two_hundred_runs, R"(, "keep": {"worst": 2, "of": "a"})");
  const std::string file = folder.folder.path("sweep.json"), results = folder.results();
  EXPECT_EQ(exit_code(fmt::format("{} sweep {} -o {} -j 2", program, file, results)), 0);
  EXPECT_EQ(exit_code(fmt::format("{} sweep report {}", program, results)), 0);
  EXPECT_THAT(content(results + "/results.csv"), HasSubstr("run,mass.mass"));
  EXPECT_THAT(content(results + "/report.html"), HasSubstr("Worst cases"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(results + "/traces"), {}), 4);  // CSV and page
  for (const auto& trace : std::filesystem::directory_iterator(results + "/traces"))
    if (trace.path().extension() == ".html") {
      EXPECT_THAT(content(results + "/report.html"),
                  HasSubstr("href=\"traces/" + trace.path().filename().string() + '"'));
    }
  EXPECT_EQ(
      exit_code(fmt::format("{} sweep report {} -o {}", program, results, folder.folder.path("page.html"))),
      0);
  EXPECT_THAT(content(folder.folder.path("page.html")), HasSubstr("href=\"results/traces/run_"));
  EXPECT_EQ(exit_code(fmt::format("{} sweep {} -o {}", program, file, results)), 1);  // holds results
  EXPECT_EQ(exit_code(fmt::format("{} sweep {} -o {} --resume", program, file, results)), 0);  // all there
  EXPECT_EQ(exit_code(fmt::format("{} sweep {}", program, file)), 2);                          // no folder
  EXPECT_EQ(exit_code(fmt::format("{} sweep {} -o {} --shard 3/3", program, file, results)), 2);
  EXPECT_EQ(exit_code(fmt::format("{} sweep report {}", program, folder.folder.path("."))), 2);
  EXPECT_EQ(exit_code(fmt::format("{} sweep {} --minimize a --evaluations 20", program, file)), 0);
}

TEST(SweepProgram, SharesRunsAmongRanksAndGivesTheTableOfOneProcess) {
  if (exit_code("command -v mpirun") != 0) GTEST_SKIP() << "mpirun is not installed";
  const SweepFolder folder(two_hundred_runs);
  const std::string file = folder.folder.path("sweep.json");
  ASSERT_EQ(exit_code(fmt::format("{} sweep {} -o {} -j 1", program, file, folder.results("one"))), 0);
  ASSERT_EQ(
      exit_code(fmt::format("{} {} sweep {} -o {} -j 1", four_ranks, program, file, folder.results("four"))),
      0);
  EXPECT_EQ(content(folder.results("four") + "/results.csv"),
            content(folder.results("one") + "/results.csv"));
  // Runs that a lost rank had not written are repeated.
  const auto shards = shard_files(folder.results("four"));
  std::filesystem::resize_file(shards[0], std::filesystem::file_size(shards[0]) / 2);
  if (shards.size() > 1) std::filesystem::remove(shards[1]);
  ASSERT_EQ(exit_code(fmt::format("{} {} sweep {} -o {} -j 1 --resume", four_ranks, program, file,
                                  folder.results("four"))),
            0);
  EXPECT_EQ(content(folder.results("four") + "/results.csv"),
            content(folder.results("one") + "/results.csv"));
}

// The rank is killed as soon as it has written a block; mpirun then ends the others. The ranks give way to
// who watches. On a busy computer he may come too late all the same: then he tries again.
TEST(SweepProgram, MakesWhatAKilledRankLeftAndGivesTheSameTable) {
  if (exit_code("command -v mpirun") != 0) GTEST_SKIP() << "mpirun is not installed";
  const SweepFolder folder(R"("mass.mass": {"linear": {"from": 0.5, "to": 2, "count": 10000}})",
                           R"(, "set": {"solver.stop": 2})", R"("a": {"rms": "mass.position"})");
  const std::string file = folder.folder.path("sweep.json"),
                    shard = folder.results() + "/runs_0_of_1_rank_2.shard";
  const std::string killed = fmt::format(
      "[ $OMPI_COMM_WORLD_RANK = 2 ] && (until [ $(stat -c %s {0} 2>/dev/null || echo 0) -gt 200 ]; do sleep "
      "0.002; done; kill -9 $$) & exec nice -n 19 {1} sweep {2} -o {3} -j 1 --lanes scalar",
      shard, program, file, folder.results());
  const SweepPlan plan = folder.plan();
  SweepResults left;
  int code = 0;
  for (int attempt = 0; attempt < 10 && left.missing == 0; ++attempt) {
    std::filesystem::remove_all(folder.results());
    code = exit_code(fmt::format("{} sh -c '{}'", four_ranks, killed));
    left = read_results(plan, folder.results());
  }
  EXPECT_GT(left.missing, 0);
  EXPECT_NE(code, 0);
  EXPECT_GT(left.table.rows(), 0u);
  ASSERT_EQ(exit_code(fmt::format("{} {} sweep {} -o {} -j 1 --resume", four_ranks, program, file,
                                  folder.results())),
            0);
  ASSERT_EQ(exit_code(fmt::format("{} sweep {} -o {} -j 1", program, file, folder.results("one"))), 0);
  EXPECT_EQ(content(folder.results() + "/results.csv"), content(folder.results("one") + "/results.csv"));
}

}  // namespace
}  // namespace loopwright::program_test
