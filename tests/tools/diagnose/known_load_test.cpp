// A load on a spring that the diagram knows.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tests/tools/loaded_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::known_load_test {
namespace {

/// It begins where the record does, and as fast: at the diagram's own start its spring would be strained by
/// the whole way, and a record that begins far away would show nothing but its swinging.
TEST(KnownLoad, BeginsWithTheRecord) {
  for (const double origin : {0.0, 0.7, 50.0}) {
    DiagramFolder folder;
    LoadedAxis{.origin = origin, .velocity = 0.4, .force_noise = 0.02, .encoder = 1e-7, .rows = 12000}
        .write_to(folder);
    const Diagnosis d = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
    EXPECT_EQ(name_of(d.verdict), "nothing_missing") << origin << "\n" << to_text(d);
    EXPECT_LT(d.steps.front().force_rmse, 0.03) << origin;
    EXPECT_LT(d.steps.front().simulation_rmse, 1e-4) << origin;
  }
}

/// Few rows count beside its turns, and in these noise can stand for what a wrong spring does. The forces
/// that are left tell.
TEST(KnownLoad, OnAWrongSpringIsNotCalledRight) {
  constexpr double motor = 1.3, load = 0.7, hz = 12;
  const double w = 2 * std::numbers::pi * hz, stiffness = load * w * w, damping = 0.26 * load * w;
  HiddenMachine machine;
  machine.mass = motor + load, machine.damping = 5, machine.force_noise = 0.05;
  machine.position_port = "mass.motor_position", machine.velocity_port = "mass.motor_velocity";
  machine.moving = fmt::format(
      R"("mass": {{"type": "TwoMass", "motor_mass": {{"value": {}, "unit": "kg"}},
 "load_mass": {{"value": {}, "unit": "kg"}}, "stiffness": {{"value": {}, "unit": "N/m"}},
 "damping": {{"value": {}, "unit": "N*s/m"}}, "in": {{"force": "net_force.sum"}}}})",
      motor, load, 0.7 * stiffness, damping);
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.load_kg = load, truth.gap_m = -1, truth.coupling_n_per_m = stiffness;
  truth.coupling_n_s_per_m = damping;
  WantedMotion motion = there_and_back(0.15, 0.4);
  const WantedMotion once = motion;
  motion.position.insert(motion.position.end(), once.position.begin(), once.position.end());
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("wrong_spring", truth, motion)});
  EXPECT_EQ(name_of(d.verdict), "unexplained") << to_text(d);
}

}  // namespace
}  // namespace loopwright::known_load_test
