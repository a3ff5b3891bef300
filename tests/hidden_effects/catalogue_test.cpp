// The catalogue's blocks, inserted into the nominal diagram with the true parameters, must move as the true
// plant does: two independent implementations of each law, with different solvers.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "tools/compare/compare.h"
#include "tools/effects/insert.h"

extern "C" {
#include "tests/hidden_effects/write.h"
}

namespace fs = std::filesystem;
namespace loopwright::catalogue_test {

namespace {

std::string read_text(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

const InsertionSite site{{{"position", "axis.position"},
                          {"velocity", "axis.velocity"},
                          {"force", "axis.net_force"},
                          {"input", "axis.force"}},
                         {},
                         {}};

RecordSizes sizes_of(const Scenario& scenario) {
  RecordSizes sizes;
  sizes.stroke = sizes.highest_position = 0.6;
  sizes.top_speed = 0.35;
  sizes.top_acceleration = 3;
  sizes.force_level = sizes.input_level = 0.6;
  sizes.machine_mass = scenario.stages[0].mass_kg;
  sizes.machine_damping = scenario.stages[0].damping_n_s_per_m;
  sizes.resolution = scenario.noise.resolution_m;
  sizes.duration = scenario.motion.stop_s;
  return sizes;
}

/// The effect of that name, in its true form.
loopwright::Effect effect_of(const std::string& name, const nlohmann::json& truth) {
  const std::string form = name == "end_stop" ? "high end"
                           : name == "force_saturation" ? "iron"
                           : name == "direction_dependent_friction" ? "viscous friction"
                           : name == "stribeck_friction"
                               ? truth.at("exponent") == 1 ? "exponential fall" : "bell-shaped fall"
                               : truth.value("of", "");
  Problems problems;
  for (const loopwright::Effect& effect : load_catalogue({catalogue_folder()}, problems))
    if (effect.name == name && effect.form == form) return effect;
  ADD_FAILURE() << name << " " << form << " is not in the catalogue. " << problems.text();
  return {};
}

/// The catalogue measures a spring from position zero, the truth from its rest position.
double fitted_value(const std::string& effect, const std::string& parameter, const nlohmann::json& truth) {
  if (parameter == "preload" && effect == "spring")
    return -double(truth["stiffness"]) * double(truth["rest_position"]);
  if (parameter == "preload") return 0;
  return truth.at(parameter);
}

double loop_error(const fs::path& folder, const std::string& diagram) {
  return compare(folder / diagram, folder / "true.experiment.json").signals.at(0).rmse;
}

class TrueEffect : public testing::TestWithParam<int> {};

TEST_P(TrueEffect, InTheDiagramMovesAsThePlantDoes) {
  const auto effect_index = static_cast<::Effect>(GetParam());
  const std::string name = effect_names[effect_index];
  Scenario scenario;
  ASSERT_TRUE(scenario_hiding(21, FORWARD, &effect_index, 1, &scenario));
  const fs::path folder = fs::path(testing::TempDir()) / ("hidden_" + name);
  ASSERT_TRUE(scenario_write(&scenario, folder.c_str()));

  std::string experiment = read_text(folder / "closed_loop.experiment.json");
  experiment.replace(experiment.find("\"position_m\""), 12, "\"true_model_position_m\"");
  write_text(folder / "true.experiment.json", experiment);

  const auto truth = nlohmann::json::parse(read_text(folder / "truth.json"))["effects"][0]["parameters"];
  const loopwright::Effect effect = effect_of(name, truth);
  std::vector<double> fitted;
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.is_fitted) fitted.push_back(fitted_value(name, parameter.name, truth));
  Problems problems;
  const auto file = read_source(folder / "nominal.json", {}, problems);
  const auto improved = insert_effect(file, site, effect, fitted, sizes_of(scenario), problems);
  ASSERT_TRUE(improved) << problems.text();
  write_text(folder / "improved.json", improved->text);

  const double before = loop_error(folder, "nominal.json"), after = loop_error(folder, "improved.json");
  // True dry friction holds rigidly, that of the catalogue yields over a short distance: they differ while
  // the axis is at rest.
  const bool gives = effect_index == COULOMB_FRICTION || effect_index == STRIBECK_FRICTION;
  EXPECT_LT(after, gives ? 0.12 * before : 0.005 * before + scenario.noise.resolution_m)
      << before << " m before";
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TrueEffect, testing::Range(0, int(CATALOGUE)),
                         [](const auto& effect) { return std::string(effect_names[effect.param]); });

}  // namespace

}  // namespace loopwright::catalogue_test
