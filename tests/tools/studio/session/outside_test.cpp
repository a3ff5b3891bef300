#include <gtest/gtest.h>
#include <atomic>
#include <random>
#include <thread>
#include "tests/tools/studio/session/studio_folder.h"
#include "engine/json/json.h"
#include "tools/studio/session/document.h"

namespace loopwright::studio::outside_test {

namespace {

const char* const axis = R"({
  "loopwright": 1,
  "parameters": {
    "mass":    {"value": 0.5, "unit": "kg"},
    "damping": {"value": 3, "unit": "N*s/m"}
  },
  "solver": {"stop": 1},
  "blocks": {
    "push": {"type": "Step", "time": 0.1, "after": {"value": 1, "unit": "N"}},
    "net":  {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "drag.force"]}},
    "mass": {"type": "Mass", "mass": "=mass", "in": {"force": "net.sum"}},
    "drag": {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "mass.velocity"}}
  }
}
)";

Edited edit(Document& document, const std::string& intent) {
  return document.edit({json_value(intent)}, {}, {}, document.revision());
}

std::string replaced_in(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST(OtherFiles, AreAllChangedOrNone) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  folder.write("a.json", "{\"a\": 1}");
  const Folder served(folder.path());
  Document document(served, "axis.json");
  const std::string changed = replaced_in(axis, "0.5", "2");
  // The second one is another than the step believes.
  const std::vector<OtherFile> others{{"a.json", "{\"a\": 1}", "{\"a\": 2}"},
                                      {"b.json", std::nullopt, "{}"},
                                      {"c.json", "{\"c\": 1}", "{\"c\": 2}"}};
  EXPECT_THROW(document.take("a step", changed, others, {}), Refused);
  EXPECT_EQ(folder.read("axis.json"), axis);
  EXPECT_EQ(folder.read("a.json"), "{\"a\": 1}");
  EXPECT_FALSE(std::filesystem::exists(folder.path("b.json")));
}

TEST(OtherFiles, ThatAStepMadeAreGoneAfterUndo) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  document.take("a step", replaced_in(axis, "0.5", "2"), {{"b.json", std::nullopt, "{}"}}, {});
  EXPECT_EQ(folder.read("b.json"), "{}");
  document.undo();
  EXPECT_FALSE(std::filesystem::exists(folder.path("b.json")));
  document.redo();
  EXPECT_EQ(folder.read("b.json"), "{}");
}

TEST(Outside, AChangeEndsWhatCouldBeRedone) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  edit(document, R"({"intent": "set_parameter", "name": "damping", "text": "1234"})");
  document.undo();
  const std::string theirs = replaced_in(axis, "{\n", "{\n  \"title\": \"longer than before\",\n");
  folder.write("axis.json", theirs);
  ASSERT_TRUE(document.look());
  EXPECT_THROW(document.redo(), Refused);
  EXPECT_EQ(folder.read("axis.json"), theirs);
  document.undo();
  EXPECT_EQ(folder.read("axis.json"), axis);
}

TEST(Outside, AChangeIsTakenOverAndEditsApplyToIt) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  folder.write("axis.json", replaced_in(axis, "\"value\": 3", "\"value\": 7"));
  EXPECT_THROW(edit(document, R"({"intent": "set_parameter", "name": "mass", "text": "2"})"),
               ChangedMeanwhile);
  EXPECT_NE(folder.read("axis.json").find("\"value\": 7"), std::string::npos) << "never written over";
  EXPECT_TRUE(document.look());
  edit(document, R"({"intent": "set_parameter", "name": "mass", "text": "2"})");
  const std::string both = replaced_in(replaced_in(axis, "0.5", "2"), "\"value\": 3", "\"value\": 7");
  EXPECT_EQ(folder.read("axis.json"), both);
  document.undo();
  document.undo();
  EXPECT_EQ(folder.read("axis.json"), axis) << "the change from outside is a step, too";
  document.redo();
  document.redo();
  EXPECT_EQ(folder.read("axis.json"), both);
}

TEST(Outside, UnsavedTextIsMergedOrAPersonDecides) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  const std::string half = replaced_in(axis, "\"stop\": 1", "\"stop\": ");
  edit(document, R"({"intent": "replace_text", "text": )" + to_json([&] {
                   Value text;
                   text.kind = Value::Kind::text, text.text = half;
                   return text;
                 }()) +
                     "}");
  EXPECT_FALSE(document.is_saved());
  EXPECT_EQ(folder.read("axis.json"), axis) << "what is no JSON is not written";
  folder.write("axis.json", replaced_in(axis, "\"value\": 3", "\"value\": 7"));
  EXPECT_TRUE(document.look());
  EXPECT_FALSE(document.conflict()) << "other lines";
  EXPECT_EQ(document.text(), replaced_in(half, "\"value\": 3", "\"value\": 7"));
  folder.write("axis.json", replaced_in(axis, "\"stop\": 1", "\"stop\": 9"));
  EXPECT_TRUE(document.look());
  ASSERT_TRUE(document.conflict());
  const std::string mine = document.text();
  document.resolve(*document.conflict());
  EXPECT_EQ(document.text(), folder.read("axis.json"));
  document.undo();
  EXPECT_EQ(document.text(), mine) << "what was given up is still there";
}

TEST(Outside, ReadOnlyFilesAndLinksAreNotWritten) {
  const StudioFolder folder, elsewhere;
  elsewhere.write("axis.json", axis);
  std::filesystem::create_symlink(elsewhere.path("axis.json"), folder.path("link.json"));
  std::filesystem::create_directory_symlink(elsewhere.path(), folder.path("out"));
  const Folder served(folder.path());
  for (const char* path : {"link.json", "out/axis.json"}) {
    Document document(served, path);
    EXPECT_FALSE(served.is_writable(path));
    EXPECT_THROW(edit(document, R"({"intent": "set_parameter", "name": "mass", "text": "2"})"), Refused);
    EXPECT_EQ(document.text(), axis);
  }
  EXPECT_EQ(elsewhere.read("axis.json"), axis);
}

TEST(Outside, PathsNeverLeadOut) {
  const StudioFolder folder;
  const Folder served(folder.path());
  for (const char* path :
       {"", "/etc/passwd", "../x.json", "a/../../x.json", "./x.json", "a//x.json", ".hidden.json",
        ".git/x.json", "x", "x.txt", "x.json/", "a/.ssh/x.json", "x\n.json", ".loopwright"})
    EXPECT_THROW(served.path_of(path), Refused) << path;
  EXPECT_THROW(served.path_of(std::string("a\0.json", 7)), Refused);
  EXPECT_EQ(served.path_of("a/x.json"), folder.path("a/x.json"));
}

/// Another program writes numbered versions, in place and by renaming, while the studio edits: no version and
/// no edit is lost.
TEST(Outside, NothingIsLostWhileOthersWrite) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  std::atomic<bool> is_over{false};
  std::atomic<int> written{0};
  std::thread other([&] {
    std::mt19937 random(5);
    for (int version = 1; version <= 60; ++version) {
      // As an editor does: it changes what it has read, and looks again if the file is not as it was.
      while (true) {
        const std::string now = folder.read("axis.json");
        const size_t begin = now.find("\"damping\": {\"value\": ");
        if (begin == now.npos) continue;
        const size_t from = begin + 21, to = now.find(',', from);
        const std::string next = now.substr(0, from) + std::to_string(version) + now.substr(to);
        const auto found = served.replace("axis.json", now, next);
        if (!found) break;
      }
      ++written;
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    }
    is_over = true;
  });
  int edits = 0;
  while (!is_over || edits == 0) {
    try {
      document.look();
      edit(document,
           R"({"intent": "set_parameter", "name": "mass", "text": ")" + std::to_string(edits + 1) + "\"}");
      ++edits;
    } catch (const Refused&) {
    }
  }
  other.join();
  document.look();
  const std::string last = folder.read("axis.json");
  EXPECT_NE(last.find("\"damping\": {\"value\": 60,"), last.npos) << last;
  EXPECT_NE(last.find("\"mass\":    {\"value\": " + std::to_string(edits) + ","), last.npos) << last;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().filename(), "axis.json") << "nothing is left behind";
}

}  // namespace loopwright::studio::outside_test
