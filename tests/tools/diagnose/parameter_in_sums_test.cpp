// A parameter that a sum or a difference reads: what it does is no power of it.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::parameter_in_sums_test {
namespace {

void expect_only(const Diagnosis& d, const std::string& name, double value) {
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_TRUE(d.effects.empty()) << to_text(d);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  const MovedParameter& moved = d.moved_parameters[0];
  EXPECT_EQ(moved.name, name);
  EXPECT_NEAR(moved.value, value, 0.003 * value) << to_text(d);
}

/// A valve sends a share of a pump's flow to one tank, and the rest to the other: a power of the share would
/// ask for another pump.
TEST(ParameterInSums, OfAValveGoesTheRestElsewhere) {
  constexpr double share = 0.6;
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A valve between two tanks",
  "parameters": {"pump": 0.2, "share": 0.7},
  "solver": {"method": "rk4", "step": 0.05, "stop": 10},
  "blocks": {
    "drive":    {"type": "Constant", "value": 0},
    "flow":     {"type": "Gain", "gain": "=pump", "in": {"u": "drive.y"}},
    "to_left":  {"type": "Gain", "gain": "=share", "in": {"u": "flow.y"}},
    "to_right": {"type": "Gain", "gain": "=1 - share", "in": {"u": "flow.y"}},
    "out_left": {"type": "Gain", "gain": {"value": 0.1, "unit": "1/s"}, "in": {"u": "left.y"}},
    "out_right": {"type": "Gain", "gain": {"value": 0.15, "unit": "1/s"}, "in": {"u": "right.y"}},
    "net_left": {"type": "Sum", "signs": "+-", "in": {"terms": ["to_left.y", "out_left.y"]}},
    "net_right": {"type": "Sum", "signs": "+-", "in": {"terms": ["to_right.y", "out_right.y"]}},
    "left":     {"type": "Integrator", "initial": 0, "in": {"u": "net_left.sum"}},
    "right":    {"type": "Integrator", "initial": 0, "in": {"u": "net_right.sum"}}
  }})json";
  plant.drive = R"("flow.u": {"column": "u", "unit": "1"})",
  plant.compare = R"("left.y": {"column": "y0", "unit": "s"}, "right.y": {"column": "y1", "unit": "s"})";
  plant.rate = [](const Numbers& x, double u, const Numbers&) {
    return Numbers{share * 0.2 * u - 0.1 * x[0], (1 - share) * 0.2 * u - 0.15 * x[1]};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0], x[1]}; };
  plant.input = [steps = random_steps(6, 2)](double t) { return 2 + steps(t); };
  plant.initial = Numbers(2), plant.measurement_noise = {2e-3, 2e-3};
  plant.sample_time = 0.2, plant.rows = 1200;
  expect_only(diagnosed(plant), "share", share);
}

/// The inertia of a pendulum is a sum with the square of its length, its weight a product with it.
TEST(ParameterInSums, OfAPendulumTheLengthIsInTwoLaws) {
  constexpr double length = 0.36;
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "A pendulum on a motor",
  "parameters": {"rotor": {"value": 0.02, "unit": "kg*m^2"}, "mass": {"value": 0.4, "unit": "kg"},
                 "length": {"value": 0.3, "unit": "m"}, "gravity": {"value": 9.81, "unit": "m/s^2"},
                 "bearing": {"value": 0.03, "unit": "N*m*s/rad"}},
  "solver": {"method": "rk4", "step": 0.005, "stop": 10},
  "blocks": {
    "off":    {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
    "drive":  {"type": "Gain", "gain": 1, "in": {"u": "off.y"}},
    "weight": {"type": "Expression", "formula": "mass*gravity*length*sin(q)", "names": ["q"], "in": {"arguments": ["arm.angle"]}},
    "drag":   {"type": "Gain", "gain": "=bearing", "in": {"u": "arm.velocity"}},
    "net":    {"type": "Sum", "signs": "+--", "in": {"terms": ["drive.y", "weight.y", "drag.y"]}},
    "arm":    {"type": "Inertia", "inertia": "=rotor + mass*length^2", "in": {"torque": "net.sum"}}
  }})json";
  plant.drive = R"("drive.u": {"column": "u", "unit": "N*m"})";
  plant.compare = R"("arm.angle": {"column": "y0", "unit": "rad"})";
  plant.rate = [](const Numbers& x, double u, const Numbers&) {
    const double inertia = 0.02 + 0.4 * length * length;
    return Numbers{x[1], (u - 0.4 * 9.81 * length * std::sin(x[0]) - 0.03 * x[1]) / inertia};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0]}; };
  plant.input = [steps = random_steps(0.4, 7)](double t) { return 0.8 * steps(t); };
  plant.initial = Numbers(2), plant.measurement_noise = {5e-4};
  plant.sample_time = 0.01, plant.rows = 2000;
  expect_only(diagnosed(plant), "length", length);
}

}  // namespace
}  // namespace loopwright::parameter_in_sums_test
