#include <gtest/gtest.h>
#include <set>
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/effect_run.h"

namespace loopwright::catalogue_test {

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
                                          "encoder_periodic_error"};
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

}  // namespace loopwright::catalogue_test
