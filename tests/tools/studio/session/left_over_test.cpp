/// Hidden files of a studio that was killed while it wrote.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

namespace loopwright::studio::left_over_test {

namespace {

constexpr const char* axis =
    R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"c": {"type": "Constant", "value": 1}}})";

/// The number of a process that has ended.
int ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return int(child);
}

class LeftOvers : public testing::Test {
 protected:
  LeftOvers() { folder_.write("axis.json", axis); }
  std::string leave(const std::string& name, const std::string& text, int process) {
    const std::string file = fmt::format(".{}.studio-{}-0", name, process);
    folder_.write(file, text);
    return file;
  }
  bool is_there(const std::string& file) const { return std::filesystem::exists(folder_.path(file)); }
  StudioFolder folder_;
};

}  // namespace

TEST_F(LeftOvers, WithThePresentTextAreRemoved) {
  const std::string same = leave("axis.json", axis, ended_process());
  folder_.write("below/b.json", axis);
  folder_.write(fmt::format("below/.b.json.studio-{}-12", ended_process()), axis);
  Page page(folder_.path(), "axis.json");
  EXPECT_TRUE(page.ask({{"do", "hello"}})["left_over"].empty());
  EXPECT_FALSE(is_there(same));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path("below")), {}), 1);
}

TEST_F(LeftOvers, WithAnotherTextStayAndAreTold) {
  const std::string text = std::string(axis) + "\n";
  const std::string other = leave("axis.json", text, ended_process());
  const std::string cut = leave("gone.json", "{\"loop", ended_process());
  Page page(folder_.path(), "axis.json");
  const Json list = page.ask({{"do", "hello"}})["left_over"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["file"], other);
  EXPECT_EQ(list[0]["path"], "axis.json");
  EXPECT_EQ(list[0]["text"], text);
  EXPECT_FALSE(list[0]["when"].get<std::string>().empty());
  EXPECT_TRUE(is_there(other) && is_there(cut));
  // Put into the file as a step; the hidden file stays until it is removed.
  page.ask(
      {{"do", "edit"}, {"path", "axis.json"}, {"intents", {{{"intent", "replace_text"}, {"text", text}}}}});
  EXPECT_EQ(folder_.read("axis.json"), text);
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(folder_.read("axis.json"), axis);
  EXPECT_TRUE(is_there(other));
  EXPECT_EQ(page.ask({{"do", "remove_left_over"}, {"file", other}})["left_over"].size(), 1u);
  EXPECT_FALSE(is_there(other));
  EXPECT_TRUE(is_there(cut));
}

TEST_F(LeftOvers, OnlyFilesOfProcessesThatAreGoneAndOnlyThoseThatAreNamed) {
  const std::string mine = leave("axis.json", "mine", ::getpid());
  const std::string foreign = ".axis.json.studio-x-0", plain = ".axis.json.swp";
  folder_.write(foreign, "x"), folder_.write(plain, "x");
  const std::string other = leave("axis.json", "other", ended_process());
  Page page(folder_.path(), "axis.json");
  EXPECT_EQ(page.ask({{"do", "hello"}})["left_over"].size(), 1u);
  for (const std::string& file : {mine, foreign, plain, std::string("axis.json"), "../" + other})
    EXPECT_TRUE(page.wait(page.send({{"do", "remove_left_over"}, {"file", file}})).contains("error")) << file;
  // What another program made of it meanwhile is not removed.
  folder_.write(other, "newer");
  EXPECT_TRUE(page.wait(page.send({{"do", "remove_left_over"}, {"file", other}})).contains("error"));
  for (const std::string& file : {mine, foreign, plain, other, std::string("axis.json")})
    EXPECT_TRUE(is_there(file)) << file;
}

}  // namespace loopwright::studio::left_over_test
