/// What stays: runs with a name, sweeps as files, fitted values; and the limits of sliders.
#include <filesystem>
#include <fmt/format.h>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"
#include "tools/sweep/lane_group.h"

namespace loopwright::studio::keeping_test {

namespace {

constexpr const char* axis = R"({
  "loopwright": 1,
  "parameters": {"mass": {"value": 0.5, "unit": "kg"}, "damping": {"value": 0, "unit": "N*s/m"},
                 "bias": {"value": 0, "unit": "N"}},
  "solver": {"method": "rk4", "step": 0.001, "stop": 1},
  "blocks": {
    "push": {"type": "Sine", "amplitude": {"value": 1, "unit": "N"}, "frequency": {"value": 1, "unit": "Hz"}, "bias": "=bias"},
    "net":  {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "drag.force"]}},
    "mass": {"type": "Mass", "mass": "=mass", "in": {"force": "net.sum"}},
    "drag": {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "mass.velocity"}}
  },
  "log": ["mass.position"]
})";

class Keeping : public testing::Test {
 protected:
  Keeping() { folder_.write("axis.json", axis); }
  Json runs(Page& page) const { return page.ask({{"do", "runs"}, {"path", "axis.json"}})["runs"]; }
  Json runs_after_restart() const {
    Page page(folder_.path(), "axis.json");
    return runs(page);
  }
  StudioFolder folder_;
};

TEST_F(Keeping, ARunWithANameIsThereAfterARestartWithItsSignals) {
  Json last;
  {
    Page page(folder_.path(), "axis.json");
    const Json run = page.ask({{"do", "run"}, {"path", "axis.json"}, {"set", {{"mass", "2 kg"}}}});
    page.ask(
        {{"do", "name_run"}, {"run", run["run"]}, {"name", "heavy"}, {"note", "a note"}, {"keep", true}});
    // Forty further runs, as a slider makes them, do not push it out.
    for (int i = 0; i < 40; ++i) page.ask({{"do", "run"}, {"path", "axis.json"}});
    EXPECT_EQ(runs(page)[0]["name"], "heavy");
    last = page.ask({{"do", "signals"}, {"source", fmt::format("run:{}", run["run"].get<int>())}});
  }
  Page page(folder_.path(), "axis.json");
  const Json kept = runs(page);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0]["name"], "heavy");
  EXPECT_EQ(kept[0]["note"], "a note");
  EXPECT_EQ(kept[0]["set"]["mass"], "2 kg");
  EXPECT_FALSE(kept[0]["file_changed"]) << "with its own numbers, the file gives the same run";
  const std::string source = fmt::format("run:{}", kept[0]["run"].get<int>());
  EXPECT_EQ(page.ask({{"do", "signals"}, {"source", source}}), last);
  // A second one with the same plan has a file of its own.
  const Json again = page.ask({{"do", "run"}, {"path", "axis.json"}, {"set", {{"mass", "2 kg"}}}});
  page.ask({{"do", "name_run"}, {"run", again["run"]}, {"name", "second"}, {"note", ""}, {"keep", true}});
  EXPECT_EQ(runs_after_restart().size(), 2u);
  // Without a name it is not kept any more, and still shown.
  page.ask({{"do", "name_run"}, {"run", kept[0]["run"]}, {"name", ""}, {"note", ""}, {"keep", false}});
  EXPECT_EQ(page.ask({{"do", "signals"}, {"source", source}}), last);
  EXPECT_EQ(runs_after_restart().size(), 1u);
}

TEST_F(Keeping, WhatIsNoKeptRunIsLeftOut) {
  folder_.write(".loopwright/runs/a.json", "{}");
  folder_.write(".loopwright/runs/b.json", "nonsense");
  folder_.write(".loopwright/runs/c.json", R"({"path": "axis.json", "name": 3})");
  for (const char* name : {"a", "b", "c"})
    folder_.write(fmt::format(".loopwright/runs/{}.csv", name), "time\n0\n");
  Page page(folder_.path(), "axis.json");
  EXPECT_EQ(runs(page).size(), 0u);
}

TEST_F(Keeping, ASweepIsRepeatedByTheFileThatIsWritten) {
  Page page(folder_.path(), "axis.json");
  Json request{{"do", "sweep"},
               {"path", "axis.json"},
               {"metric", "rms(mass.position)"},
               {"set", {{"bias", "0.5 N"}, {"mass", "9 kg"}}},
               {"x", {{"set", "mass"}, {"unit", "kg"}, {"low", 0.5}, {"high", 1}, {"points", 3}}},
               {"y", {{"set", "damping"}, {"unit", "N*s/m"}, {"low", 0}, {"high", 2}, {"points", 2}}}};
  request["do"] = "write_sweep";
  const Json answer = page.ask(request);
  EXPECT_EQ(answer["file"], "axis.sweep.json");
  EXPECT_NE(answer["command"].get<std::string>().find("loopwright sweep "), std::string::npos);
  const Json file = Json::parse(folder_.read("axis.sweep.json"));
  EXPECT_EQ(file["diagram"], "axis.json");
  EXPECT_EQ(file["set"], (Json{{"bias", "0.5 N"}})) << "what is swept is not set besides";
  EXPECT_EQ(file["axes"]["mass"]["linear"]["count"], 3);
  EXPECT_EQ(file["axes"]["damping"]["unit"], "N*s/m");
  EXPECT_EQ(file["metrics"]["rms"]["rms"], "mass.position");
  // The same again needs no new file; another one does not replace it.
  EXPECT_EQ(page.ask(request)["file"], "axis.sweep.json");
  request["x"]["points"] = 4;
  EXPECT_NE(page.ask(request)["file"], "axis.sweep.json");
}

/// Every figure, against the program's own sweep of the file that is written.
TEST_F(Keeping, AFigureOfASweepIsThatOfTheFile) {
  Page page(folder_.path(), "axis.json");
  for (const char* figure : {"rms", "peak", "maximum", "minimum", "mean", "final"}) {
    SCOPED_TRACE(figure);
    Json request{{"do", "sweep"},
                 {"path", "axis.json"},
                 {"metric", fmt::format("{}(mass.position)", figure)},
                 {"set", {{"bias", "-0.5 N"}}},
                 {"x", {{"set", "mass"}, {"unit", "kg"}, {"low", 0.5}, {"high", 1}, {"points", 3}}},
                 {"y", {{"set", "damping"}, {"unit", "N*s/m"}, {"low", 0}, {"high", 2}, {"points", 2}}}};
    const Json swept = page.ask(request);
    request["do"] = "write_sweep";
    Problems problems;
    const auto sweep = load_sweep(folder_.path(page.ask(request)["file"]), problems);
    ASSERT_TRUE(sweep) << problems.text();
    const SweepPlan plan(sweep);
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 2; ++j) {
        const int64_t run = int64_t(2 * i + j);
        const double value = swept["values"][j][i];
        EXPECT_NEAR(value, make_alone(plan, plan.options(run), run).metrics[0],
                    1e-12 + 1e-12 * std::abs(value));
      }
  }
  const Json refused = page.wait(page.send({{"do", "sweep"},
                                            {"path", "axis.json"},
                                            {"metric", "median(mass.position)"},
                                            {"x", {{"set", "mass"}, {"low", 1}, {"high", 2}}},
                                            {"y", {{"set", "damping"}, {"low", 1}, {"high", 2}}}}));
  EXPECT_TRUE(refused.contains("error"));
}

TEST_F(Keeping, TheSliderOfAZeroStaysWithinWhatItsBlocksAccept) {
  Page page(folder_.path(), "axis.json");
  const Json view = page.ask({{"do", "open"}, {"path", "axis.json"}})["view"];
  for (const Json& parameter : view["parameters"]) {
    if (parameter["name"] == "damping") {
      EXPECT_EQ(parameter["slider"]["low"], 0.0) << "friction refuses a negative coefficient";
    }
    if (parameter["name"] == "bias") {
      EXPECT_LT(parameter["slider"]["low"], 0.0) << "a force may have either sign";
    }
  }
}

TEST_F(Keeping, AFitMovesTheChosenNumbersAndIsOneStepOfUndo) {
  // The record is of a heavier mass.
  Page page(folder_.path(), "axis.json");
  const Json truth =
      page.ask({{"do", "run"}, {"path", "axis.json"}, {"set", {{"mass", "0.8 kg"}}}, {"points", 20000}});
  std::string csv = "time [s],x [m]\n";
  const Json& signal = truth["signals"][0];
  for (size_t i = 0; i < signal["x"].size(); ++i)
    csv += fmt::format("{},{}\n", signal["x"][i].get<double>(), signal["y"][i].get<double>());
  folder_.write("record.csv", csv);
  folder_.write(
      "record.experiment.json",
      R"({"loopwright": 1, "data": "record.csv", "time": "time", "compare": {"mass.position": {"column": "x"}}})");
  Json request{{"do", "fit"},
               {"path", "axis.json"},
               {"experiments", {"record.experiment.json"}},
               {"parameters", {"mass"}}};
  const Json fit = page.ask(request);
  ASSERT_EQ(fit["parameters"].size(), 1u) << fit.dump(1);
  EXPECT_LT(fit["signals"][0]["after"].get<double>(), 1e-6 * fit["signals"][0]["before"].get<double>());
  EXPECT_NE(fit["command"].get<std::string>().find("--parameters mass"), std::string::npos);
  EXPECT_EQ(folder_.read("axis.json"), axis) << "nothing is written before the user asks";
  const Json written = page.ask({{"do", "write_fit"}, {"path", "axis.json"}, {"fit", fit["fit"]}});
  EXPECT_EQ(written["document"]["undo"], "write fitted values");
  const double mass = Json::parse(folder_.read("axis.json"))["parameters"]["mass"]["value"];
  EXPECT_NEAR(mass, 0.8, 1e-6);
  page.ask({{"do", "undo"}, {"path", "axis.json"}});
  EXPECT_EQ(folder_.read("axis.json"), axis);
  // Values of a diagram that was changed since would be written over what the user did.
  const Json refused =
      page.wait(page.send({{"do", "write_fit"}, {"path", "axis.json"}, {"fit", fit["fit"]}}));
  EXPECT_TRUE(refused.contains("error"));
}

}  // namespace

}  // namespace loopwright::studio::keeping_test
