/// A force that is in no catalogue: it is told, learned, and kept as a lookup block.
#include <fmt/format.h>
#include <cmath>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

extern "C" {
#include "tests/hidden_effects/scenario.h"
#include "tests/hidden_effects/write.h"
}

namespace loopwright::studio::learned_test {

namespace {

/// The axis as it is believed to be, with bumps along its way that nothing describes.
std::string with_bumps(const std::string& axis) {
  Json diagram = Json::parse(axis);
  std::vector<double> at, force;
  const auto bump = [](double x, double place, double width) {
    return std::exp(-std::pow((x - place) / width, 2));
  };
  for (double x = -0.1; x < 0.7; x += 0.02) {
    at.push_back(x);
    force.push_back(0.6 * bump(x, 0.15, 0.05) - 0.8 * bump(x, 0.33, 0.03) + 0.5 * bump(x, 0.52, 0.07));
  }
  diagram["blocks"]["bumps"] = {
      {"type", "Lookup1D"}, {"breakpoints", at}, {"values", force}, {"in", {{"u", "mass.position"}}}};
  diagram["blocks"]["net_force"]["signs"] = "+---";
  diagram["blocks"]["net_force"]["in"]["terms"].push_back("bumps.y");
  return diagram.dump(1);
}

std::string replaced_in(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST(LearnedFunction, IsKeptAsALookupBlockAndUndone) {
  const StudioFolder folder;
  Scenario scenario;
  const ::Effect effects[] = {COULOMB_FRICTION, COGGING};
  ASSERT_TRUE(scenario_hiding(21, PAPER, effects, 2, &scenario) &&
              scenario_write(&scenario, folder.path().c_str()));
  folder.write("bumps.json", with_bumps(folder.read("axis.json")));
  folder.write("true.json", replaced_in(folder.read("nominal.json"), "axis.json", "bumps.json"));
  Page page(folder.path());
  const Json run = page.ask({{"do", "run"}, {"path", "true.json"}, {"points", 20000}});
  std::map<std::string, Json> signals;
  for (const Json& signal : run["signals"]) signals[signal["name"]] = signal;
  std::string csv = "time_s,force_N,position_m\n";
  const Json &force = signals["controller.force"], &position = signals["axis.position"];
  ASSERT_EQ(force["x"], position["x"]) << "every sample";
  for (size_t i = 0; i < force["x"].size(); ++i) {
    const double counted = std::round(position["y"][i].get<double>() / 2e-7) * 2e-7;
    csv +=
        fmt::format("{:.3f},{},{:.9f}\n", force["x"][i].get<double>(), force["y"][i].get<double>(), counted);
  }
  folder.write("bumps.csv", csv);
  folder.write("bumps.experiment.json",
               replaced_in(folder.read("train.experiment.json"), "train.csv", "bumps.csv"));
  const std::string original = folder.read("nominal.json");

  const Json diagnosis =
      page.ask({{"do", "diagnose"}, {"path", "nominal.json"}, {"experiments", {"bumps.experiment.json"}}});
  ASSERT_TRUE(diagnosis["unknown"].is_object()) << diagnosis["text"];
  EXPECT_EQ(diagnosis["unknown"]["variables"][0], "position");
  ASSERT_EQ(diagnosis["unknown"]["learned"].size(), 1u) << diagnosis["unknown"].dump(1);
  const Json learned = diagnosis["unknown"]["learned"][0];
  const Json compare{{"do", "compare"}, {"path", "nominal.json"}, {"experiment", "bumps.experiment.json"}};
  const double before = page.ask(compare)["force"]["rmse"];
  const Json preview = page.ask({{"do", "preview"},
                                 {"path", "nominal.json"},
                                 {"diagnosis", diagnosis["diagnosis"]},
                                 {"effects", {learned["effect"]}}});
  EXPECT_GT(preview["x"].size(), 100u);
  EXPECT_EQ(folder.read("nominal.json"), original) << "a preview writes nothing";
  page.ask({{"do", "add_effects"},
            {"path", "nominal.json"},
            {"diagnosis", diagnosis["diagnosis"]},
            {"effects", {learned["effect"]}}});
  EXPECT_NE(folder.read("nominal.json").find("Lookup1D"), std::string::npos);
  EXPECT_LT(page.ask(compare)["force"]["rmse"].get<double>(), 0.05 * before);
  page.ask({{"do", "undo"}, {"path", "nominal.json"}});
  EXPECT_EQ(folder.read("nominal.json"), original);
}

}  // namespace loopwright::studio::learned_test
