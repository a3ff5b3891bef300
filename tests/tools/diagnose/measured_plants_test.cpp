// The diagnosis of machines that others built and measured: a motor held at many places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <set>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/diagnose/diagnose.h"
#include "where.h"

namespace loopwright::measured_plants_test {
namespace {

bool has_data(const std::string& file) {
  setenv("LOOPWRIGHT_DATA", LOOPWRIGHT_SOURCE "/../shared/data", 0);
  return std::filesystem::exists(std::string(std::getenv("LOOPWRIGHT_DATA")) + "/" + file);
}

/// Torques in the current that makes them.
constexpr const char* held_rotor = R"json({"loopwright": 1, "title": "A motor that is held",
  "solver": {"method": "rk4", "step": 0.001, "stop": 1},
  "blocks": {
    "none":    {"type": "Constant", "value": {"value": 0, "unit": "A"}},
    "motor":   {"type": "Gain", "gain": 1, "in": {"u": "none.y"}},
    "viscous": {"type": "ViscousFriction", "damping": {"value": 1e-3, "unit": "A*s/rad"}, "in": {"velocity": "rotor.velocity"}},
    "net":     {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
    "rotor":   {"type": "Mass", "mass": {"value": 1e-3, "unit": "A*s^2/rad"}, "in": {"force": "net.sum"}}
  }})json";
constexpr const char* holding_map =
    R"json({"loopwright": 1, "data": "bldc_cogging_odrive/holding_current_map_a_4.csv", "rows": "balances",
  "drive":   {"motor.u": {"column": "iq_A", "unit": "A"}},
  "compare": {"rotor.position": {"column": "theta_rad", "unit": "rad", "resolution": 7.67e-4}},
  "roles":   {"position": "rotor.position", "velocity": "rotor.velocity", "force": "net.sum", "input": "motor.u"},
  "hold_out": {"fraction": 0.3}})json";

/// A third of the turn is held out: what is found must go on there. Functions of position without a name,
/// which stand for the longest lines, do not.
TEST(MeasuredPlants, AMapOfATurnShowsAllOrdersOfItsCogging) {
  if (!has_data("bldc_cogging_odrive/holding_current_map_a_4.csv"))
    GTEST_SKIP() << "no bldc_cogging_odrive/holding_current_map_a_4.csv below $LOOPWRIGHT_DATA";
  DiagramFolder folder;
  folder.with("nominal.json", held_rotor), folder.with("map.experiment.json", holding_map);
  const Diagnosis d = diagnose(folder.path("nominal.json"), {folder.path("map.experiment.json")});
  std::set<int> orders;
  for (const DiagnosedEffect& effect : d.effects)
    if (effect.name == "cogging")
      for (const DiagnosedParameter& p : effect.parameters)
        if (p.name == "pitch") orders.insert(int(std::lround(2 * std::numbers::pi / p.value)));
  for (int order : {7, 28, 14, 36, 12, 84})
    EXPECT_TRUE(orders.contains(order)) << order << "\n" << to_text(d);
  EXPECT_NEAR(d.error_before, 0.874, 0.01) << "A, held out";
  EXPECT_LT(d.error_after, 0.12) << to_text(d);
}

}  // namespace
}  // namespace loopwright::measured_plants_test
