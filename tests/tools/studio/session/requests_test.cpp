#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

namespace loopwright::studio::requests_test {

namespace {

/// A mass on a spring and damper, held by a sampled controller: 10 kHz, so that a second has more rows than a
/// scope has room for.
constexpr const char* loop = R"({
  "loopwright": 1,
  "parameters": {"mass": {"value": 0.5, "unit": "kg"}, "gain": {"value": 400, "unit": "N/m"}},
  "solver": {"method": "rk4", "step": 0.0001, "stop": 1},
  "blocks": {
    "reference": {"type": "Step", "after": 0.001},
    "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["reference.y", "plant.position"]}},
    "controller": {"type": "Gain", "gain": "=gain", "in": {"u": "hold.y"}},
    "hold": {"type": "ZeroOrderHold", "sample_time": 0.0001, "in": {"u": "error.sum"}},
    "friction": {"type": "Gain", "gain": {"value": -20, "unit": "N*s/m"}, "in": {"u": "plant.velocity"}},
    "sum": {"type": "Sum", "signs": "++", "in": {"terms": ["controller.y", "friction.y"]}},
    "plant": {"type": "Mass", "mass": "=mass", "in": {"force": "sum.sum"}}
  },
  "log": ["plant.position", "controller.y"]
})";

class Requests : public testing::Test {
 protected:
  Requests() { folder_.write("loop.json", loop); }
  Json signal(const Json& run, const std::string& name) const {
    for (const Json& entry : run["signals"])
      if (entry["name"] == name) return entry;
    ADD_FAILURE() << name << " is not in " << run.dump().substr(0, 500);
    return {};
  }
  StudioFolder folder_;
};

TEST_F(Requests, ALoopIsAnalysedCutWithMarginsAndClosedWithoutThem) {
  Page page(folder_.path(), "loop.json");
  Json request{{"do", "linearize"}, {"path", "loop.json"}, {"from", "plant.force"}, {"to", "plant.position"}};
  const Json closed = page.ask(request);
  EXPECT_TRUE(closed["margins"].is_null()) << "nothing is cut";
  EXPECT_FALSE(closed["is_loop_gain"]);
  EXPECT_TRUE(closed["sampled"]);
  EXPECT_DOUBLE_EQ(closed["sample_time"], 1e-4);
  for (const Json& pole : closed["poles"]) {
    const double size = std::hypot(pole["re"].get<double>(), pole["im"].get<double>());
    EXPECT_LT(size, 1) << "a stable sampled pole lies in the unit circle";
    EXPECT_EQ(pole["stability"], "stable") << "and its positive real part does not make it unstable";
  }
  request["break"] = "plant.force", request["to"] = "plant.force";
  const Json open = page.ask(request);
  EXPECT_TRUE(open["is_loop_gain"]);
  ASSERT_TRUE(open["margins"].is_object());
  EXPECT_TRUE(open["margins"]["stable"]);
  EXPECT_GT(open["margins"]["phase_deg"], 10);
  EXPECT_GT(open["nyquist"]["circle"]["re"].size(), 10u);
  EXPECT_TRUE(open["nyquist"]["re"][0].is_null()) << "far from -1, where the mass is an integrator";
  EXPECT_TRUE(closed["nyquist"]["circle"].is_null());
  // Both poles of the cut mass are integrators.
  int at_boundary = 0;
  for (const Json& pole : open["poles"]) at_boundary += pole["stability"] == "boundary";
  EXPECT_EQ(at_boundary, 2) << open["poles"].dump(1);
  // At low frequency, L = (gain + friction s)/(mass s^2).
  const double w = open["frequency"][0];
  const std::complex<double> s(0, w), expected = (400. + 20. * s) / (0.5 * s * s);
  EXPECT_NEAR(open["magnitude_db"][0], 20 * std::log10(std::abs(expected)), 0.1);
  EXPECT_NEAR(std::remainder(open["phase_deg"][0].get<double>() - std::arg(expected) * 180 / M_PI, 360), 0,
              2);
}

TEST_F(Requests, ALinearAnalysisFollowsTheSliders) {
  Page page(folder_.path(), "loop.json");
  Json request{{"do", "linearize"},
               {"path", "loop.json"},
               {"from", "plant.force"},
               {"to", "plant.force"},
               {"break", "plant.force"}};
  const Json before = page.ask(request);
  request["set"] = {{"gain", "1600 N/m"}};
  EXPECT_LT(page.ask(request)["margins"]["phase_deg"], before["margins"]["phase_deg"]);
}

TEST_F(Requests, RefusedValuesAreGapsOfASweepAndOtherSlidersCount) {
  Page page(folder_.path(), "loop.json");
  const Json mass{{"set", "mass"}, {"unit", "kg"}, {"low", -0.5}, {"high", 0.5}, {"points", 2}};
  const Json gain{{"set", "gain"}, {"unit", "N/m"}, {"low", 200}, {"high", 400}, {"points", 2}};
  Json request{
      {"do", "sweep"}, {"path", "loop.json"}, {"x", mass}, {"y", gain}, {"metric", "rms(plant.position)"}};
  const Json swept = page.ask(request);
  EXPECT_TRUE(swept["values"][0][0].is_null()) << "a negative mass, in the first cell";
  EXPECT_TRUE(swept["values"][1][0].is_null());
  // The other sliders, and those of the axes where they stand.
  request["set"] = {{"friction.gain", "-2 N*s/m"}, {"mass", "3 kg"}};
  const Json moved = page.ask(request);
  EXPECT_NE(moved["values"][0][1], swept["values"][0][1]);
  const Json run =
      page.ask({{"do", "run"},
                {"path", "loop.json"},
                {"set", {{"friction.gain", "-2 N*s/m"}, {"mass", "0.5 kg"}, {"gain", "200 N/m"}}}});
  EXPECT_EQ(moved["values"][0][1], signal(run, "plant.position")["rms"]);

  request["x"]["high"] = -0.1;
  const Json refused = page.wait(page.send(request));
  ASSERT_TRUE(refused.contains("error")) << "nothing of it runs";
  EXPECT_NE(refused["error"]["text"].get<std::string>().find("mass"), std::string::npos);
}

TEST_F(Requests, StepsAreShownOnlyWithEverySample) {
  Page page(folder_.path(), "loop.json");
  const Json run = page.ask({{"do", "run"}, {"path", "loop.json"}, {"points", 100}});
  EXPECT_FALSE(signal(run, "controller.y")["steps"]) << "thinned: no value holds from one point to the next";
  const Json window = page.ask({{"do", "signals"},
                                {"source", "run:" + run["run"].dump()},
                                {"names", {"controller.y"}},
                                {"from", 0.1},
                                {"to", 0.105},
                                {"points", 1200}});
  EXPECT_TRUE(signal(window, "controller.y")["steps"]);
  EXPECT_GE(signal(window, "controller.y")["x"].size(), 50u);
}

TEST_F(Requests, ARunWhoseFileHasChangedSaysSo) {
  Page page(folder_.path(), "loop.json");
  page.ask({{"do", "open"}, {"path", "loop.json"}});
  page.ask({{"do", "run"}, {"path", "loop.json"}});
  page.ask({{"do", "run"}, {"path", "loop.json"}, {"set", {{"mass", "0.7 kg"}}}});
  const auto changed = [&] {
    std::vector<bool> list;
    const Json answer = page.ask({{"do", "runs"}, {"path", "loop.json"}});
    for (const Json& run : answer["runs"]) list.push_back(run["file_changed"]);
    return list;
  };
  EXPECT_EQ(changed(), std::vector({false, false}));
  // The second run does not depend on the mass in the file.
  page.ask({{"do", "edit"},
            {"path", "loop.json"},
            {"intents", {{{"intent", "set_parameter"}, {"name", "mass"}, {"text", "0.6 kg"}}}}});
  EXPECT_EQ(changed(), std::vector({true, false}));
  page.ask({{"do", "undo"}, {"path", "loop.json"}});
  EXPECT_EQ(changed(), std::vector({false, false}));
}

TEST_F(Requests, TheStudioBeginsWithAFileThatRunsAlone) {
  folder_.write("a_part.json", R"({
  "loopwright": 1,
  "inputs": {"force": {"unit": "N"}},
  "outputs": {"position": "mass.position"},
  "blocks": {"mass": {"type": "Mass", "mass": 1, "in": {"force": "force"}}}
})");
  folder_.write("b_broken.json", R"({"loopwright": 1, "blocks": {"gain": {"type": "Gian"}}})");
  Page page(folder_.path(), "");
  EXPECT_EQ(page.ask({{"do", "hello"}})["open"], "loop.json");
  const Json part = page.ask({{"do", "open"}, {"path", "a_part.json"}});
  EXPECT_TRUE(part["loads"]) << part["problems"].dump(1);
  EXPECT_FALSE(part["runs_alone"]);
  EXPECT_TRUE(page.ask({{"do", "open"}, {"path", "loop.json"}})["runs_alone"]);
}

}  // namespace

TEST_F(Requests, OneOddFileHidesNoOther) {
  std::filesystem::create_symlink("/etc/hostname", folder_.path("outside.json"));
  folder_.write("two\nlines.json", "{}");
  folder_.write("\xff.json", "{}");
  folder_.write("record.csv", "t,x\n0,0\n");
  Page page(folder_.path(), "");
  const Json hello = page.ask({{"do", "hello"}});
  std::vector<std::string> paths;
  for (const Json& file : hello["files"]) paths.push_back(file["path"]);
  EXPECT_NE(std::ranges::find(paths, "loop.json"), paths.end()) << hello;
  EXPECT_NE(std::ranges::find(paths, "record.csv"), paths.end()) << hello;
  EXPECT_EQ(hello["open"], "loop.json");
  EXPECT_EQ(paths.size(), 3u) << "a link to another place is read, and never written: " << hello;
}

}  // namespace loopwright::studio::requests_test
