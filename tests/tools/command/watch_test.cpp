// `loopwright run --watch` follows every file that the run reads, and stays when one is broken.
#include <gtest/gtest.h>
#include <chrono>
#include <functional>
#include <thread>
#include "tests/tools/command/program.h"

namespace loopwright::watch_test {
namespace {

/// Whether it comes true within a time that a busy computer keeps.
bool soon(const std::function<bool()>& is_true) {
  for (int i = 0; i < 600; ++i) {
    if (is_true()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

std::string inner(const std::string& amplitude) {
  return R"({"loopwright": 1, "blocks": {"s": {"type": "Sine", "amplitude": )" + amplitude +
         R"(, "frequency": {"value": 1, "unit": "Hz"}}}, "outputs": {"y": "s.y"}})";
}

TEST(Watch, RunsAgainForEveryFileThatIsRead) {
  DiagramFolder folder;
  folder.with("inner.json", inner("1"));
  folder.with("outer.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 1},
                  "blocks": {"part": {"diagram": "inner.json"}}, "log": ["part.y"]})");
  const std::string page = folder.path("page.html"), csv = folder.path("run.csv");
  Program program({"run", "outer.json", "--watch", "--report", page, "-o", csv}, folder.path(""));
  const auto runs_with = [&](const char* greatest) {
    return soon([&] { return text_of(csv).find(greatest) != std::string::npos; });
  };
  EXPECT_TRUE(runs_with("\n0.25,1\n")) << text_of(csv);
  EXPECT_TRUE(soon([&] { return text_of(page).find("http-equiv=\"refresh\"") != std::string::npos; }));

  folder.with("inner.json", inner("3"));
  EXPECT_TRUE(runs_with("\n0.25,3\n"));
  folder.with("inner.json", inner("three"));
  EXPECT_TRUE(soon([&] { return program.err().find("inner.json:1:") != std::string::npos; }))
      << program.err();
  EXPECT_NE(text_of(csv).find("\n0.25,3\n"), std::string::npos) << "the last good run stays";
  folder.with("inner.json", inner("5"));
  EXPECT_TRUE(runs_with("\n0.25,5\n"));

  program.send(SIGINT);
  EXPECT_EQ(program.wait().code, 0);
  EXPECT_EQ(text_of(page).find("http-equiv=\"refresh\""), std::string::npos);
}

}  // namespace
}  // namespace loopwright::watch_test
