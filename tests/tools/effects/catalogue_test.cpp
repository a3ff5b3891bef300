#include <gmock/gmock.h>
#include <filesystem>
#include <set>
#include "tests/engine/written_diagram.h"
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::catalogue_test {

/// Without a word nothing would be looked for.
TEST(Catalogue, AFolderWithoutEffectsIsAnError) {
  DiagramFolder folder;
  folder.with("notes.txt", "none here");
  Problems problems;
  load_catalogue({std::filesystem::path(folder.path("notes.txt")).parent_path().string()}, problems);
  EXPECT_THAT(problems.text(), testing::HasSubstr("contains none"));
}

TEST(Catalogue, HoldsTheEffectsByTheirNames) {
  std::set<std::string> names;
  for (const Effect& effect : whole_catalogue()) names.insert(effect.name);
  const std::set<std::string> expected = {"inertia",
                                          "viscous_friction",
                                          "coulomb_friction",
                                          "stribeck_friction",
                                          "direction_dependent_friction",
                                          "quadratic_drag",
                                          "smooth_friction",
                                          "eddy_current_drag",
                                          "presliding_hysteresis",
                                          "cogging",
                                          "velocity_dependent_cogging",
                                          "force_ripple",
                                          "force_gain",
                                          "asymmetric_gain",
                                          "force_saturation",
                                          "dead_band",
                                          "constant_force",
                                          "spring",
                                          "hardening_spring",
                                          "end_stop",
                                          "backlash",
                                          "flexible_mode",
                                          "input_delay",
                                          "actuator_lag",
                                          "thermal_drift",
                                          "encoder_periodic_error",
                                          "sensor_nonlinearity"};
  EXPECT_EQ(names, expected);
}

TEST(Catalogue, CompilesForLinearAndRotaryMachines) {
  for (const Effect& effect : whole_catalogue())
    for (const MachineUnits& units : {MachineUnits{"m", "N"}, MachineUnits{"rad", "N*m"},
                                      MachineUnits{"rad", "A"}, MachineUnits{"m", "V"}}) {
      Problems problems;
      EXPECT_TRUE(compile_effect(effect, units, axis_sizes(), problems)) << effect.name << " " << effect.form;
      EXPECT_EQ(problems.text(), "") << effect.name << " " << effect.form << " in " << units.force;
    }
}

TEST(Catalogue, APartOfItLoadsWithoutComplaint) {
  for (const auto& file : std::filesystem::directory_iterator(catalogue_folder())) {
    DiagramFolder folder;
    std::filesystem::copy(file.path(), folder.path(file.path().filename().string()));
    Problems problems;
    EXPECT_FALSE(load_catalogue({folder.path("")}, problems).empty()) << file.path();
    EXPECT_EQ(problems.text(), "");
  }
}

TEST(Catalogue, ANameThatNoEffectHasIsATypingError) {
  DiagramFolder folder;
  folder.with("push.json", R"({
    "loopwright": 1, "effect": "push", "title": "A push", "physics": "Something pushes.",
    "parameters": {"level": {"unit": "$force", "linear": true, "range": [-1, 1], "start": 0.1}},
    "blocks": {"force": {"type": "ConstantForce", "level": "=level"}},
    "attach": [{"to": "force", "from": "force.force"}],
    "needs": {"text": "motion"},
    "confusable": [{"with": "sprng", "when": "always", "experiment": {"text": "Move."}}]
  })");
  Problems problems;
  load_catalogue({folder.path("")}, problems);
  EXPECT_THAT(problems.text(),
              testing::AllOf(testing::HasSubstr(R"("push" is confusable with "sprng", which is no effect)"),
                             testing::HasSubstr(R"(did you mean "spring"?)")));
}

}  // namespace loopwright::catalogue_test
