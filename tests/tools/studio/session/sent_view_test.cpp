#include "tools/studio/session/sent_view.h"
#include <filesystem>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

namespace loopwright::studio::sent_view_test {

namespace {

constexpr const char* chain = R"({
  "loopwright": 1,
  "solver": {"method": "rk4", "step": 0.01, "stop": 0.1},
  "blocks": {
    "a": {"type": "Sine", "amplitude": 1, "frequency": 1},
    "b": {"type": "Gain", "gain": 2, "in": {"u": "a.y"}},
    "inner": {"diagram": {"inputs": {"u": "1"}, "outputs": {"y": "b.y"},
                          "blocks": {"b": {"type": "Gain", "gain": 3, "in": {"u": "u"}}}}, "in": {"u": "b.y"}},
    "c": {"type": "Gain", "gain": 4, "in": {"u": "inner.y"}}
  }
})";

/// What a page makes of a view that refers to what it was sent before.
class Known {
 public:
  Json complete(Json view) {
    for (Json& block : view["blocks"]) {
      if (!block.is_string()) continue;
      ++referred_;
      for (const Json& known : before_["blocks"])
        if (known["name"] == block) {
          block = known;
          break;
        }
      EXPECT_TRUE(block.is_object()) << block << " never came";
    }
    if (view["wires"].is_null()) view["wires"] = before_["wires"];
    before_ = view;
    return view;
  }
  int referred() const { return referred_; }

 private:
  Json before_;
  int referred_ = 0;
};

Json edit_of(Json intent, const std::string& inside = "") {
  return {{"do", "edit"},
          {"path", "chain.json"},
          {"inside", inside},
          {"intents", Json::array({std::move(intent)})}};
}

}  // namespace

TEST(SentView, WithWhatCameBeforeIsTheWholeView) {
  const StudioFolder folder;
  folder.write("chain.json", chain);
  Page page(folder.path(), "chain.json");
  Known known;
  known.complete(page.ask({{"do", "open"}, {"path", "chain.json"}})["view"]);
  const std::vector<Json> requests = {
      edit_of({{"intent", "set"}, {"block", "b"}, {"setting", "gain"}, {"text", "25"}}),
      edit_of({{"intent", "rename_block"}, {"name", "a"}, {"to", "source"}}),
      edit_of({{"intent", "disconnect"}, {"to", "c.u"}, {"index", 0}}),
      {{"do", "undo"}, {"path", "chain.json"}},
      edit_of({{"intent", "add_block"}, {"type", "Gain"}, {"name", "a"}}),
      edit_of({{"intent", "set"}, {"block", "b"}, {"setting", "gain"}, {"text", "7"}}, "inner"),
      edit_of({{"intent", "set"}, {"block", "b"}, {"setting", "gain"}, {"text", "8"}}),
      edit_of({{"intent", "remove_blocks"}, {"blocks", {"inner"}}}),
      {{"do", "undo"}, {"path", "chain.json"}},
      {{"do", "undo"}, {"path", "chain.json"}},
  };
  for (const Json& request : requests) {
    SCOPED_TRACE(request.dump());
    const Json view = known.complete(page.ask(request)["document"]["view"]);
    // A page that knows nothing is sent everything.
    Page other(folder.path(), "chain.json");
    EXPECT_EQ(view, other.ask({{"do", "open"}, {"path", "chain.json"}, {"inside", view["inside"]}})["view"]);
  }
  EXPECT_GT(known.referred(), 10) << "unchanged blocks are not sent again";
}

TEST(SentView, OfALargeDiagramIsSmallAfterASmallEdit) {
  const StudioFolder folder;
  Json diagram = Json::parse(chain);
  for (int i = 0; i < 300; ++i)
    diagram["blocks"]["g" + std::to_string(i)] = {{"type", "Gain"}, {"gain", i}, {"in", {{"u", "a.y"}}}};
  folder.write("chain.json", diagram.dump(1));
  Page page(folder.path(), "chain.json");
  const size_t whole = page.ask({{"do", "open"}, {"path", "chain.json"}})["view"].dump().size();
  const Json answer =
      page.ask(edit_of({{"intent", "set"}, {"block", "b"}, {"setting", "gain"}, {"text", "25"}}));
  EXPECT_LT(answer["document"].dump().size(), whole / 10);
}

}  // namespace loopwright::studio::sent_view_test
