#include <gtest/gtest.h>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

extern "C" {
#include "tests/hidden_effects/scenario.h"
#include "tests/hidden_effects/write.h"
}

namespace loopwright::studio::scene_test {

namespace {

class Scene : public testing::Test {
 protected:
  Scene() {
    Scenario scenario;
    const ::Effect effects[] = {COULOMB_FRICTION, COGGING};
    if (!scenario_hiding(21, PAPER, effects, 2, &scenario) ||
        !scenario_write(&scenario, folder_.path().c_str()))
      std::abort();
    for (const char* name : {"train", "floor", "held_out", "closed_loop"})
      std::filesystem::remove(folder_.path(std::string(name) + ".experiment.json"));
  }
  StudioFolder folder_;
};

}  // namespace

TEST_F(Scene, ADroppedRecordIsComparedDiagnosedAndExplained) {
  Page page(folder_.path());
  const Json hello = page.ask({{"do", "hello"}});
  EXPECT_EQ(hello["open"], "nominal.json");
  const Json document = page.ask({{"do", "open"}, {"path", "nominal.json"}});
  EXPECT_TRUE(document["loads"]) << document["problems"].dump(1);
  EXPECT_EQ(document["view"]["blocks"].size(), 3u);
  const std::string original = document["text"];
  EXPECT_EQ(original, folder_.read("nominal.json"));

  const Json run = page.ask(
      {{"do", "run"}, {"path", "nominal.json"}, {"set", {{"axis.mass", "0.3 kg"}}}, {"points", 400}});
  EXPECT_EQ(run["status"], "finished");
  EXPECT_LE(run["signals"][0]["x"].size(), 800u) << "four numbers a pixel";

  // The columns of a record, as a person would map them.
  Json columns = page.ask({{"do", "columns"}, {"path", "nominal.json"}, {"data", "train.csv"}});
  std::map<std::string, std::pair<std::string, std::string>> guessed;
  for (const Json& column : columns["columns"]) guessed[column["column"]] = {column["use"], column["port"]};
  EXPECT_EQ(columns["time"], "time_s");
  EXPECT_EQ(guessed["reference_m"], std::pair(std::string("drive"), std::string("controller.reference")));
  EXPECT_EQ(guessed["position_m"], std::pair(std::string("compare"), std::string("axis.position")));
  EXPECT_EQ(guessed["force_N"], std::pair(std::string("compare"), std::string("controller.force")));
  EXPECT_EQ(guessed["feedforward_N"].first, "ignore");
  Json roles = Json::object();
  for (const Json& role : columns["roles"]) roles[role["role"].get<std::string>()] = role["port"];
  EXPECT_EQ(roles, Json({{"position", "axis.position"},
                         {"velocity", "axis.velocity"},
                         {"force", "axis.net_force"},
                         {"input", "axis.force"}}));
  const Json written = page.ask({{"do", "write_experiment"},
                                 {"path", "nominal.json"},
                                 {"experiment", columns["experiment"]},
                                 {"title", "Dropped"},
                                 {"data", "train.csv"},
                                 {"time", columns["time"]},
                                 {"columns", columns["columns"]},
                                 {"roles", roles},
                                 {"hold_out", 0.25}});
  EXPECT_TRUE(written["written"]) << written.dump(1);

  const Json request{{"do", "compare"}, {"path", "nominal.json"}, {"experiment", "train.experiment.json"}};
  const Json before = page.ask(request);
  EXPECT_GT(before["signals"][0]["rmse"], 50e-6);
  EXPECT_GT(before["force"]["rmse"].get<double>(), 10 * before["force"]["noise_floor"].get<double>());
  for (const Json& entry : before["tint"])
    EXPECT_EQ(entry["text"].get<std::string>().find("is off by"), std::string::npos) << "by the missing force alone";
  const Json diagnosis =
      page.ask({{"do", "diagnose"}, {"path", "nominal.json"}, {"experiments", {"train.experiment.json"}}});
  EXPECT_EQ(diagnosis["verdict"], "explained") << diagnosis["text"];
  ASSERT_EQ(diagnosis["cards"].size(), 2u);
  EXPECT_GE(page.partials().size(), 2u) << "the staircase grows while the search goes on";

  const Json preview = page.ask({{"do", "preview"},
                                 {"path", "nominal.json"},
                                 {"diagnosis", diagnosis["diagnosis"]},
                                 {"effects", {"cogging", "coulomb_friction"}}});
  EXPECT_LT(preview["rmse"], 4e-6);
  EXPECT_EQ(folder_.read("nominal.json"), original);
  const Json added = page.ask({{"do", "add_effects"},
                               {"path", "nominal.json"},
                               {"diagnosis", diagnosis["diagnosis"]},
                               {"effects", Json::array()}});
  EXPECT_EQ(added["blocks"], Json({"axis"})) << "the block of this level that contains the change";
  EXPECT_TRUE(added["document"]["loads"]);
  const Json after = page.ask(request);
  EXPECT_LT(after["signals"][0]["rmse"], 4e-6);
  for (const Json& entry : after["tint"])
    EXPECT_LE(entry["share"].get<double>(), after["force"]["relative"].get<double>() / 100) << entry;
  EXPECT_NEAR(after["signals"][0]["rmse"].get<double>(), preview["rmse"].get<double>(), 1e-12)
      << "as previewed";
  page.ask({{"do", "undo"}, {"path", "nominal.json"}});
  EXPECT_EQ(folder_.read("nominal.json"), original);
  EXPECT_EQ(page.ask(request)["signals"][0]["rmse"], before["signals"][0]["rmse"]);

  // One after the other, in the other order than that of the staircase.
  for (const char* effect : {"coulomb_friction", "cogging"})
    page.ask({{"do", "add_effects"},
              {"path", "nominal.json"},
              {"diagnosis", diagnosis["diagnosis"]},
              {"effects", {effect}}});
  EXPECT_LT(page.ask(request)["signals"][0]["rmse"], 4e-6);
}

TEST_F(Scene, ARenamedBlockIsRenamedInItsExperiments) {
  folder_.write("a.experiment.json",
                "{\n  \"loopwright\": 1, \"data\": \"train.csv\", \"time\": \"time_s\",\n"
                "  \"drive\": {\"controller.reference\": {\"column\": \"reference_m\", \"unit\": \"m\"}},\n"
                "  \"compare\": {\"axis.position\": {\"column\": \"position_m\", \"unit\": \"m\"}},\n"
                "  \"roles\": {\"force\": \"axis.net_force\"}\n}\n");
  const std::string experiment = folder_.read("a.experiment.json"), diagram = folder_.read("nominal.json");
  Page page(folder_.path());
  page.ask({{"do", "open"}, {"path", "nominal.json"}});
  page.ask({{"do", "edit"},
            {"path", "nominal.json"},
            {"intents", {{{"intent", "rename_block"}, {"name", "axis"}, {"to", "stage"}}}}});
  EXPECT_NE(folder_.read("a.experiment.json").find("{\"stage.position\""), std::string::npos);
  EXPECT_NE(folder_.read("a.experiment.json").find("\"stage.net_force\""), std::string::npos);
  EXPECT_EQ(
      page.ask({{"do", "compare"}, {"path", "nominal.json"}, {"experiment", "a.experiment.json"}})["status"],
      "finished");
  page.ask({{"do", "undo"}, {"path", "nominal.json"}});
  EXPECT_EQ(folder_.read("a.experiment.json"), experiment);
  EXPECT_EQ(folder_.read("nominal.json"), diagram);
}

TEST_F(Scene, TwoSlidersAndLinearAnalysisAreThoseOfSingleRuns) {
  Page page(folder_.path());
  page.ask({{"do", "open"}, {"path", "nominal.json"}});
  const Json axis{{"set", "axis.mass"}, {"unit", "kg"}, {"low", 0.2}, {"high", 0.3}, {"points", 2}};
  Json damping = axis;
  damping["set"] = "axis.damping", damping["unit"] = "N*s/m", damping["low"] = 2, damping["high"] = 4;
  const Json sweep = page.ask({{"do", "sweep"},
                               {"path", "nominal.json"},
                               {"x", axis},
                               {"y", damping},
                               {"set", {{"solver.stop", 2}}},
                               {"metric", "rms(axis.position)"}});
  const Json run =
      page.ask({{"do", "run"},
                {"path", "nominal.json"},
                {"set", {{"solver.stop", 2}, {"axis.mass", "0.3 kg"}, {"axis.damping", "2 N*s/m"}}}});
  for (const Json& signal : run["signals"])
    if (signal["name"] == "axis.position") {
      EXPECT_EQ(sweep["values"][0][1], signal["rms"]);
    }
  EXPECT_NE(sweep["values"][0][0], sweep["values"][1][1]);
  const Json linear = page.ask(
      {{"do", "linearize"}, {"path", "nominal.json"}, {"from", "axis.force"}, {"to", "axis.position"}});
  EXPECT_EQ(linear["frequency"].size(), linear["magnitude_db"].size());
  EXPECT_GT(linear["poles"].size(), 1u);
}

TEST_F(Scene, OvertakenAndCancelledJobsAreDroppedAtOnce) {
  Page page(folder_.path());
  page.ask({{"do", "open"}, {"path", "nominal.json"}});
  std::vector<int64_t> ids;
  for (int i = 0; i < 20; ++i)
    ids.push_back(page.send({{"do", "run"},
                             {"path", "nominal.json"},
                             {"lane", "live"},
                             {"set", {{"axis.mass", 0.2 + 0.01 * i}}}}));
  int finished = 0;
  for (int64_t id : ids) finished += page.wait(id).contains("ok");
  EXPECT_TRUE(page.wait(ids.back()).contains("ok")) << "the last one is shown";
  EXPECT_LT(finished, 20);
  const int64_t long_one = page.send(
      {{"do", "run"}, {"path", "nominal.json"}, {"set", {{"solver.stop", 12}, {"solver.step", 1e-6}}}});
  const auto begin = std::chrono::steady_clock::now();
  page.send({{"do", "cancel"}, {"job", long_one}});
  EXPECT_TRUE(page.wait(long_one).contains("dropped"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(Scene, WrongRequestsAreAnsweredWithReasons) {
  Page page(folder_.path());
  for (const Json& request :
       {Json{{"do", "nothing"}}, Json{{"do", "open"}}, Json{{"do", "open"}, {"path", "../nominal.json"}},
        Json{{"do", "open"}, {"path", "absent.json"}},
        Json{{"do", "edit"}, {"path", "nominal.json"}, {"intents", Json::array()}},
        Json{{"do", "edit"},
             {"path", "nominal.json"},
             {"intents", {{{"intent", "connect"}, {"from", "a"}, {"to", "nowhere.u"}}}}},
        Json{{"do", "edit"},
             {"path", "nominal.json"},
             {"intents", {{{"intent", "rename_block"}, {"name", "axis"}, {"to", "controller"}}}}},
        Json{{"do", "run"}, {"path", "nominal.json"}, {"set", {{"no_such", "1"}}}},
        Json{{"do", "signals"}, {"source", "run:99"}}, Json{{"do", "signals"}, {"source", "record:../x.csv"}},
        Json{{"do", "diagnose"}, {"path", "nominal.json"}, {"experiments", Json::array()}},
        Json{{"do", "preview"}, {"diagnosis", 7}}, Json{{"do", "undo"}, {"path", "nominal.json"}},
        Json{{"do", "type"}, {"type", "Gian"}},
        Json{{"do", "export"}, {"source", "run:1"}, {"to_file", "nominal.json"}}}) {
    const Json answer = page.wait(page.send(request));
    ASSERT_TRUE(answer.contains("error")) << request.dump();
    EXPECT_NE(answer["error"]["text"], "") << request.dump();
  }
  page.session().receive(1, "no JSON");
  page.session().receive(1, "[1]");
  page.session().receive(1, std::string(100'000, '['));
}

TEST_F(Scene, ASecondPageSeesWhatTheFirstChanges) {
  Page page(folder_.path());
  page.ask({{"do", "open"}, {"path", "nominal.json"}});
  std::string text = folder_.read("nominal.json");
  text.replace(text.find("as believed"), 11, "by an editor");
  folder_.write("nominal.json", text);
  page.session().look();
  ASSERT_EQ(page.events().size(), 1u);
  EXPECT_EQ(page.events()[0]["document"]["view"]["title"], "The loop, by an editor");
  EXPECT_EQ(page.events()[0]["document"]["undo"], "change from outside");
}

}  // namespace loopwright::studio::scene_test
