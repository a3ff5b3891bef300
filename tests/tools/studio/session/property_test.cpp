#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cstdlib>
#include <random>
#include "tests/tools/studio/session/shipped_diagrams.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"
#include "tools/studio/session/member_change.h"

namespace loopwright::studio::property_test {

namespace {

class RandomIntents {
 public:
  explicit RandomIntents(unsigned seed) : random_(seed) {}

  std::string next(const Value& root) {
    const Value::Member* list = root.find("blocks");
    if (!list || list->value.members.empty()) return R"({"intent": "add_block", "type": "Gain"})";
    const Value& blocks = list->value;
    const std::string block = name(blocks), other = name(blocks);
    switch (random_() % 16) {
      case 0:
        return fmt::format(R"({{"intent": "set", "block": "{}", "setting": "{}", "text": "{}"}})", block,
                           setting(blocks, block), value());
      case 1:
        return fmt::format(R"({{"intent": "connect", "from": "{}.{}", "to": "{}.{}"}})", block, port(), other,
                           port());
      case 2:
        return fmt::format(R"({{"intent": "disconnect", "to": "{}.{}", "index": {}}})", block,
                           input(blocks, block), random_() % 3);
      case 3:
        return fmt::format(R"({{"intent": "remove_blocks", "blocks": ["{}"]}})", block);
      case 4:
        return fmt::format(R"({{"intent": "remove_blocks", "blocks": ["{}", "{}"]}})", block, other);
      case 5:
        return fmt::format(R"({{"intent": "rename_block", "name": "{}", "to": "{}"}})", block, word());
      case 6:
        return fmt::format(R"({{"intent": "duplicate", "blocks": ["{}", "{}"]}})", block, other);
      case 7:
        return fmt::format(R"({{"intent": "add_block", "type": "{}"}})", type());
      case 8:
        return fmt::format(R"({{"intent": "log", "port": "{}.{}", "on": {}}})", block, port(),
                           random_() % 2 ? "true" : "false");
      case 9:
        return fmt::format(R"({{"intent": "set_solver", "name": "stop", "text": "{}"}})", value());
      case 10:
        return fmt::format(
            R"({{"intent": "add_parameter", "name": "{}", "text": "{}", "description": "a \"new\" one"}})",
            word(), value());
      case 11:
        return fmt::format(R"({{"intent": "rename_parameter", "name": "{}", "to": "{}"}})", parameter(root),
                           word());
      case 12:
        return fmt::format(R"({{"intent": "set_parameter", "name": "{}", "text": "{}"}})", parameter(root),
                           value());
      case 13:
        return fmt::format(R"({{"intent": "remove_parameter", "name": "{}"}})", parameter(root));
      case 14:
        return fmt::format(R"({{"intent": "describe_parameter", "name": "{}", "text": "{}"}})",
                           parameter(root), word());
      default:
        return fmt::format(R"({{"intent": "set_title", "text": "{}"}})", random_() % 3 ? word() : "");
    }
  }

 private:
  std::string name(const Value& object) {
    return object.members.empty() ? "none" : object.members[random_() % object.members.size()].name;
  }
  std::string setting(const Value& blocks, const std::string& block) {
    return random_() % 4 ? name(blocks.find(block)->value) : "gain";
  }
  std::string input(const Value& blocks, const std::string& block) {
    const Value::Member* in = blocks.find(block)->value.find("in");
    return in ? name(in->value) : "u";
  }
  std::string parameter(const Value& root) {
    const Value::Member* list = root.find("parameters");
    return list ? name(list->value) : "none";
  }
  template <size_t n> std::string one_of(const char* const (&list)[n]) { return list[random_() % n]; }
  std::string port() { return one_of({"y", "u", "force", "position", "sum", "terms", "value", "velocity"}); }
  std::string value() {
    return one_of({"1", "25 mm", "=2*pi", "0.3 kg", "true", "", "[1, 2]", "nonsense", "{\\\"a\\\": 1}"});
  }
  std::string word() { return one_of({"alpha", "beta", "gain_7", "new_name", "2wrong", "µ"}); }
  std::string type() {
    return one_of(
        {"Gain", "Sum", "Mass", "TransferFunction", "Lookup1D", "UnitDelay", "Encoder", "NoSuchType"});
  }

  std::mt19937 random_;
};

/// Everything but the touched members is as it was: every block that was not named keeps its bytes.
void expect_others_untouched(const ParsedText& before, const ParsedText& after,
                             const std::vector<std::string>& touched) {
  const Value::Member *old_blocks = before.root.find("blocks"), *blocks = after.root.find("blocks");
  if (!old_blocks || !blocks) return;
  for (const Value::Member& block : old_blocks->value.members) {
    const Value::Member* now = blocks->value.find(block.name);
    if (now && std::ranges::find(touched, block.name) == touched.end()) {
      EXPECT_EQ(source_of(block.value), source_of(now->value)) << block.name;
    }
  }
}

}  // namespace

/// LOOPWRIGHT_INTENTS=1000 for a longer search: intents for each of the shipped diagrams.
TEST(Intents, ChangeOnlyWhatTheyNameAndAreUndoneToTheByte) {
  const char* asked = std::getenv("LOOPWRIGHT_INTENTS");
  const int count = asked ? std::atoi(asked) : 30;
  const StudioFolder folder;
  const Folder served(folder.path());
  const std::vector<std::string> paths = shipped_diagrams(folder);
  ASSERT_GT(paths.size(), 100u);
  int carried_out = 0, refused = 0;
  for (size_t p = 0; p < paths.size(); ++p) {
    Document document(served, paths[p]);
    const std::string original = document.text();
    RandomIntents intents(unsigned(p + 1));
    int steps = 0;
    for (int i = 0; i < count; ++i) {
      const ParsedText before(paths[p], document.text());
      const std::string text = intents.next(before.root);
      SCOPED_TRACE(paths[p] + " " + text);
      const Value intent = json_value(text);
      ASSERT_EQ(intent.kind, Value::Kind::object);
      Edited edited;
      try {
        edited = document.edit({intent}, {}, {}, document.revision());
      } catch (const Refused&) {
        ++refused;
        ASSERT_EQ(document.text(), before.file->text);
        continue;
      }
      ++carried_out;
      ASSERT_EQ(applied(before.file->text, edited.changes), document.text());
      ASSERT_TRUE(document.is_saved()) << "what canvas intents leave is JSON";
      ASSERT_EQ(folder.read(paths[p]), document.text());
      const ParsedText after(paths[p], document.text());
      const bool names_all = text.find("rename") != text.npos || text.find("remove_blocks") != text.npos;
      if (!names_all) expect_others_untouched(before, after, edited.blocks);
      const bool has_step = document.text() != before.file->text || !edited.others.empty();
      if (!has_step) continue;
      ++steps;
      if (i % 3) {
        document.undo();
        --steps;
        ASSERT_EQ(document.text(), before.file->text);
      }
    }
    // The diagram loads if and only if `check` says so.
    const CheckedText checked = check_text(folder.path(paths[p]), document.text(), {});
    Problems problems;
    const CheckedDiagram from_disk =
        check_diagram(load_diagram(folder.path(paths[p]), {}, problems), problems);
    EXPECT_EQ(checked.loads(), !from_disk.summary().empty() && !problems.has_errors()) << paths[p];
    EXPECT_NO_THROW(view_json(checked, "", {}, {})) << paths[p];
    while (steps-- > 0) document.undo();
    EXPECT_EQ(folder.read(paths[p]), original) << paths[p];
  }
  EXPECT_GT(carried_out, count * int(paths.size()) / 4) << refused << " were refused";
}

TEST(TextChanges, ComposeInvertAndRebase) {
  std::mt19937 random(3);
  const auto changes_of = [&](const std::string& text) {
    TextChanges changes;
    for (size_t at = random() % 5; at < text.size() && changes.size() < 4; at += 1 + random() % 7) {
      const size_t to = std::min(text.size(), at + random() % 4);
      changes.push_back({at, to, std::string(random() % 4, char('A' + random() % 26))});
      at = to;
    }
    return changes;
  };
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = "the first text\nand its second line\n";
    const TextChanges first = changes_of(text);
    const std::string middle = applied(text, first);
    const TextChanges second = changes_of(middle);
    const std::string last = applied(middle, second);
    ASSERT_EQ(applied(text, composed(text.size(), first, second)), last);
    ASSERT_EQ(applied(middle, inverse(text, first)), text);
    ASSERT_EQ(applied(text, difference(text, last)), last);
    // Changes of different places can be made in either order.
    const TextChanges other = changes_of(text);
    const auto mine = rebased(other, first), theirs = rebased(first, other);
    if (!mine || !theirs) continue;
    ASSERT_EQ(applied(middle, *mine), applied(applied(text, other), *theirs));
  }
}

TEST(TextChanges, CountAsBrowsersDo) {
  const std::string text = "aµ€😀b";
  const Utf16 places(text);
  EXPECT_EQ(places.units(text.size()), 6u);
  EXPECT_EQ(places.bytes(5), text.size() - 1);
  for (size_t unit : {0u, 1u, 2u, 3u, 5u, 6u}) EXPECT_EQ(places.units(places.bytes(unit)), unit);
}

}  // namespace loopwright::studio::property_test
