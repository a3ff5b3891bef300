/// Other files that name what is renamed in a diagram: sweeps, experiments, diagrams that contain it, and
/// theirs.
#include <gtest/gtest.h>
#include <map>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"
#include "tools/studio/session/checked_text.h"
#include "tools/sweep/sweep_plan.h"

namespace loopwright::studio::followers_test {

namespace {

constexpr const char* axis = R"({
  "loopwright": 1,
  "parameters": {"mass": {"value": 0.5, "unit": "kg"}, "gains": [1, 2], "half": "=mass/2"},
  "solver": {"method": "rk4", "step": 0.001, "stop": 0.1},
  "inputs": {"force": "N"},
  "blocks": {
    "net":  {"type": "Sum", "signs": "+-", "in": {"terms": ["force", "drag.force"]}},
    "mass": {"type": "Mass", "mass": "=mass", "in": {"force": "net.sum"}},
    "drag": {"variants": {"linear": {"type": "ViscousFriction", "damping": 3}, "none": {"type": "ViscousFriction", "damping": 0}}, "in": {"velocity": "mass.velocity"}}
  },
  "outputs": {"position": "mass.position"}
}
)";

/// Contains the axis, once in a subdiagram that is written in it.
constexpr const char* loop = R"({
  "loopwright": 1,
  "parameters": {"load": {"value": 1, "unit": "kg"}},
  "solver": {"method": "rk4", "step": 0.001, "stop": 0.1},
  "blocks": {
    "push":  {"type": "Step", "time": 0.01, "after": {"value": 1, "unit": "N"}},
    "speed": {"type": "Gain", "gain": 2, "in": {"u": "stage.mass.velocity"}},
    "stage": {"diagram": "axis.json", "parameters": {"mass": "=load"}, "in": {"force": "push.y"}},
    "cell":  {"diagram": {"inputs": {"force": "N"},
                          "blocks": {"inner": {"diagram": "axis.json", "in": {"force": "force"}},
                                     "twice": {"type": "Gain", "gain": 2, "in": {"u": "inner.mass.position"}}},
                          "outputs": {"fast": "inner.mass.velocity"}},
              "in": {"force": "push.y"}}
  },
  "log": ["stage.mass.position", "cell.inner.mass.*", "stage.net.sum"],
  "figures": [{"signal": "stage.mass.position", "reference": "cell.inner.mass.position"}]
}
)";

/// Of the axis alone: the names are the same, the paths are not.
constexpr const char* sweep = R"({
  "loopwright": 1, "diagram": "./loop.json",
  "set":      {"stage.mass.initial_velocity": 0, "solver.stop": 0.05},
  "variants": {"stage.drag": "linear"},
  "axes": {
    "stage.mass":  {"values": [1,  2], "unit": "kg"},
    "load":        {"values": [1, 2], "unit": "kg"},
    "cell.inner.drag": {"variants": ["linear", "none"]},
    "stage.mass.initial_position": {"values": [0, 1]}
  },
  "paired": [["stage.mass", "stage.mass.initial_position"]],
  "metrics": {
    "stage": {"rms": "stage.mass.position", "unit": "mm"},
    "both":  {"peak": "=stage.mass.position - 2*cell.inner.mass.position"}
  },
  "keep": {"worst": 1, "of": "stage"}
}
)";

constexpr const char* experiment =
    R"({"loopwright": 1, "data": "r.csv", "drive": {"push.y": {"column": "u"}}, "compare": {"stage.mass.position": {"column": "stage.mass.position"}}, "sites": ["stage.net.sum"], "set": {"stage.mass": "1 kg", "stage.mass.payload": 0.5}})";

std::string with_all(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

class Followers : public testing::Test {
 protected:
  Followers() {
    folder_.write("axis.json", axis);
    folder_.write("loop.json", loop);
    folder_.write("a.sweep.json", sweep);
    folder_.write("loop.experiment.json", experiment);
  }
  std::map<std::string, std::string> all() const {
    std::map<std::string, std::string> texts;
    for (const Folder::File& file : Folder(folder_.path()).files())
      texts[file.path] = folder_.read(file.path);
    return texts;
  }
  Json rename(Page& page, const std::string& kind, const std::string& name, const std::string& to) {
    return page.ask({{"do", "edit"},
                     {"path", "axis.json"},
                     {"intents", {{{"intent", "rename_" + kind}, {"name", name}, {"to", to}}}}});
  }
  Json refused(Page& page, Json request) {
    const Json answer = page.wait(page.send(std::move(request)));
    EXPECT_TRUE(answer.contains("error")) << answer.dump();
    return answer.value("error", Json::object());
  }
  void expect_all_load() const {
    for (const char* name : {"axis.json", "loop.json"}) {
      const CheckedText text = check_text(folder_.path(name), folder_.read(name), {});
      EXPECT_TRUE(text.loads()) << name << text.problems.text();
    }
    Problems problems;
    const auto read = load_sweep(folder_.path("a.sweep.json"), problems);
    ASSERT_TRUE(read) << problems.text();
    EXPECT_NO_THROW(SweepPlan{read});
  }
  StudioFolder folder_;
};

}  // namespace

TEST_F(Followers, FollowABlockAtAnyDepthAndComeBackWithOneUndo) {
  expect_all_load();
  const auto before = all();
  Page page(folder_.path(), "axis.json");
  const Json answer = rename(page, "block", "mass", "slide");
  EXPECT_EQ(answer["others"].size(), 3u) << answer["others"].dump(1);
  EXPECT_EQ(answer["renamed"], (Json{{{"kind", "block"}, {"from", "mass"}, {"to", "slide"}}}));
  expect_all_load();
  // Only paths that lead through the block; the parameter of the same name and everything else stays.
  EXPECT_EQ(folder_.read("loop.json"),
            with_all(with_all(loop, "stage.mass.", "stage.slide."), "inner.mass.", "inner.slide."));
  EXPECT_EQ(folder_.read("a.sweep.json"),
            with_all(with_all(sweep, "stage.mass.", "stage.slide."), "inner.mass.", "inner.slide."));
  // The column of the record is still called as it was.
  EXPECT_EQ(folder_.read("loop.experiment.json"),
            with_all(with_all(experiment, "\"stage.mass.position\": {", "\"stage.slide.position\": {"),
                     "stage.mass.payload", "stage.slide.payload"));
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(all(), before);
  const Json again = page.ask({{"do", "redo"}, {"path", "axis.json"}});
  EXPECT_EQ(again["renamed"][0]["to"], "slide");
  expect_all_load();
}

TEST_F(Followers, FollowAParameter) {
  const auto before = all();
  Page page(folder_.path(), "axis.json");
  rename(page, "parameter", "mass", "moved");
  expect_all_load();
  EXPECT_EQ(folder_.read("loop.json"), with_all(loop, "{\"mass\": \"=load\"}", "{\"moved\": \"=load\"}"));
  EXPECT_EQ(folder_.read("a.sweep.json"), with_all(sweep, "\"stage.mass\"", "\"stage.moved\""));
  EXPECT_EQ(folder_.read("loop.experiment.json"),
            with_all(experiment, "\"stage.mass\":", "\"stage.moved\":"));
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(all(), before);
}

TEST_F(Followers, FollowBlocksThatAreWrapped) {
  const auto before = all();
  Page page(folder_.path(), "axis.json");
  page.ask({{"do", "edit"},
            {"path", "axis.json"},
            {"intents", {{{"intent", "wrap"}, {"blocks", {"mass", "net"}}, {"name", "body"}}}}});
  expect_all_load();
  EXPECT_NE(folder_.read("a.sweep.json").find("\"stage.body.mass.initial_position\": {"), std::string::npos);
  EXPECT_NE(folder_.read("loop.experiment.json").find("\"stage.body.net.sum\""), std::string::npos);
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(all(), before);
}

TEST_F(Followers, FollowInTheExpressionsOfASweepWhereTheyMeanTheParameter) {
  folder_.write(
      "b.sweep.json",
      R"({"loopwright": 1, "diagram": "axis.json", "set": {"half": "=mass/3", "gains.1": "=mass*0+3"},
 "axes": {"mass": {"values": [1, 2]}, "gains.0": {"values": [1, 2]}}, "metrics": {"x": {"final": "mass.position"}}})");
  folder_.write("c.sweep.json", R"({"loopwright": 1, "diagram": "loop.json", "set": {"load": "=mass/3"},
 "axes": {"stage.gains.0": {"values": [1, 2]}}, "metrics": {"x": {"final": "stage.mass.position"}}})");
  const std::string others_own = folder_.read("c.sweep.json"), own = folder_.read("b.sweep.json");
  Page page(folder_.path(), "axis.json");
  rename(page, "parameter", "mass", "m");
  EXPECT_EQ(folder_.read("b.sweep.json"), with_all(with_all(own, "\"=mass", "\"=m"), "\"mass\":", "\"m\":"));
  EXPECT_EQ(folder_.read("c.sweep.json"), others_own) << "another diagram's parameter of the same name";
  rename(page, "parameter", "gains", "gain_list");
  EXPECT_NE(folder_.read("b.sweep.json").find("\"gain_list.0\""), std::string::npos);
  EXPECT_NE(folder_.read("c.sweep.json").find("\"stage.gain_list.0\""), std::string::npos);
}

TEST_F(Followers, FollowWhereNumbersAreTakenOutOfTheText) {
  folder_.write("copy.json",
                R"({"loopwright": 1, "parameters": {"m": {"file": "axis.json", "name": "parameters.mass"}},
 "solver": {"stop": 1}, "blocks": {"c": {"type": "Constant", "value": "=m"}}})");
  Page page(folder_.path(), "axis.json");
  rename(page, "parameter", "mass", "moved");
  EXPECT_NE(folder_.read("copy.json").find("\"parameters.moved\""), std::string::npos);
}

TEST_F(Followers, AreNamedIfTheyCannotAndThenNothingIsDoneWithoutConsent) {
  const StudioFolder elsewhere;
  elsewhere.write("a.sweep.json", sweep);
  std::filesystem::create_symlink(elsewhere.path("a.sweep.json"), folder_.path("link.sweep.json"));
  std::filesystem::create_symlink(folder_.path("a.sweep.json"), folder_.path("same.sweep.json"));
  folder_.write("broken.sweep.json", R"({"diagram": "axis.json", "axes": {"mass")");
  folder_.write("machine.json", loop);
  const auto before = all();
  Page page(folder_.path(), "axis.json");
  Json request{{"do", "edit"},
               {"path", "axis.json"},
               {"intents", {{{"intent", "rename_block"}, {"name", "mass"}, {"to", "slide"}}}}};
  const Json error = refused(page, request);
  EXPECT_TRUE(error.value("consent", false)) << error.dump();
  const std::string text = error["text"];
  EXPECT_NE(text.find("\"link.sweep.json\" is read-only, or a link"), std::string::npos) << text;
  EXPECT_NE(text.find("\"broken.sweep.json\" is not JSON"), std::string::npos) << text;
  EXPECT_EQ(text.find("same.sweep.json"), std::string::npos) << "it leads to one that follows: " << text;
  EXPECT_EQ(text.find("machine.json"), std::string::npos) << "it contains the axis, and follows: " << text;
  EXPECT_EQ(all(), before);
  request["despite_others"] = true;
  page.ask(request);
  expect_all_load();
  EXPECT_EQ(folder_.read("broken.sweep.json"), before.at("broken.sweep.json"));
  EXPECT_EQ(elsewhere.read("a.sweep.json"), sweep);
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(all(), before);
}

TEST_F(Followers, AnExperimentThatFitsAnotherDiagramTooIsNamed) {
  folder_.write("machine.json", R"({"loopwright": 1, "solver": {"stop": 1},
    "blocks": {"push": {"type": "Constant", "value": 1}, "stage": {"type": "Gain", "in": {"u": "push.y"}}}})");
  Page page(folder_.path(), "loop.json");
  Json request{{"do", "edit"},
               {"path", "loop.json"},
               {"intents", {{{"intent", "rename_block"}, {"name", "stage"}, {"to", "slide"}}}}};
  const std::string text = refused(page, request)["text"];
  EXPECT_NE(text.find("\"loop.experiment.json\" fits \"machine.json\" too"), std::string::npos) << text;
  request["despite_others"] = true;
  page.ask(request);
  EXPECT_NE(folder_.read("loop.experiment.json").find("slide.mass.position"), std::string::npos);
}

TEST_F(Followers, AVariantThatKeepsTheNameIsNamed) {
  folder_.write("other.json", with_all(axis, "\"damping\": 3", "\"damping\": 4"));
  folder_.write(
      "two.json",
      R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "stage": {"variants": {"a": {"diagram": "axis.json"}, "b": {"diagram": "other.json"}}, "in": {"force": "push.y"}}}, "log": ["stage.mass.position"]})");
  Page page(folder_.path(), "axis.json");
  const Json request{{"do", "edit"},
                     {"path", "axis.json"},
                     {"intents", {{{"intent", "rename_block"}, {"name", "mass"}, {"to", "slide"}}}}};
  const std::string text = refused(page, request)["text"];
  EXPECT_NE(text.find("\"two.json\" reads inside \"stage\", another variant"), std::string::npos) << text;
}

TEST_F(Followers, ThatChangedMeanwhileKeepWhatOthersWrote) {
  Page page(folder_.path(), "axis.json");
  rename(page, "block", "mass", "slide");
  // Another place: it stays, and the old name comes back.
  const std::string edited =
      with_all(folder_.read("a.sweep.json"), "\"keep\": {\"worst\": 1", "\"keep\": {\"worst\": 2");
  folder_.write("a.sweep.json", edited);
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(folder_.read("a.sweep.json"), with_all(sweep, "\"worst\": 1", "\"worst\": 2"));
  rename(page, "block", "mass", "slide");
  // The same place: nothing is done, and the message says where.
  folder_.write("a.sweep.json",
                with_all(folder_.read("a.sweep.json"), "stage.slide.position", "stage.net.sum"));
  const auto before = all();
  const Json error = refused(page, {{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_NE(error["text"].get<std::string>().find("a.sweep.json"), std::string::npos);
  EXPECT_EQ(all(), before);
}

}  // namespace loopwright::studio::followers_test
