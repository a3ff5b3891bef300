// A single wrong parameter among many that the record tells poorly.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::one_parameter_test {
namespace {

struct Chain {
  double m2 = 1.5, k2 = 1500;  ///< true; the diagram has these
};

/// Three masses on a wall, shaken at the first; only the last is measured.
Plant chain(const Chain& true_one) {
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "Three masses in a chain",
  "parameters": {"m1": {"value": 1, "unit": "kg"}, "m2": {"value": 1.5, "unit": "kg"}, "m3": {"value": 0.8, "unit": "kg"},
                 "k1": {"value": 900, "unit": "N/m"}, "k2": {"value": 1500, "unit": "N/m"}, "k3": {"value": 1100, "unit": "N/m"},
                 "c1": {"value": 4, "unit": "N*s/m"}, "c2": {"value": 2, "unit": "N*s/m"}, "c3": {"value": 2, "unit": "N*s/m"}},
  "solver": {"method": "rk4", "step": 0.001, "stop": 1},
  "blocks": {
    "off":    {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "shaker": {"type": "Gain", "gain": 1, "in": {"u": "off.y"}},
    "wall":   {"type": "Constant", "value": {"value": 0, "unit": "m"}},
    "still":  {"type": "Constant", "value": {"value": 0, "unit": "m/s"}},
    "link1":  {"type": "ElasticCoupling", "stiffness": "=k1", "damping": "=c1", "in": {"motor_position": "mass1.position",
               "motor_velocity": "mass1.velocity", "load_position": "wall.y", "load_velocity": "still.y"}},
    "link2":  {"type": "ElasticCoupling", "stiffness": "=k2", "damping": "=c2", "in": {"motor_position": "mass1.position",
               "motor_velocity": "mass1.velocity", "load_position": "mass2.position", "load_velocity": "mass2.velocity"}},
    "link3":  {"type": "ElasticCoupling", "stiffness": "=k3", "damping": "=c3", "in": {"motor_position": "mass2.position",
               "motor_velocity": "mass2.velocity", "load_position": "mass3.position", "load_velocity": "mass3.velocity"}},
    "net1":   {"type": "Sum", "signs": "+--", "in": {"terms": ["shaker.y", "link1.force", "link2.force"]}},
    "net2":   {"type": "Sum", "signs": "+-", "in": {"terms": ["link2.force", "link3.force"]}},
    "mass1":  {"type": "Mass", "mass": "=m1", "in": {"force": "net1.sum"}},
    "mass2":  {"type": "Mass", "mass": "=m2", "in": {"force": "net2.sum"}},
    "mass3":  {"type": "Mass", "mass": "=m3", "in": {"force": "link3.force"}}
  }})json";
  plant.drive = R"("shaker.u": {"column": "u", "unit": "N"})";
  plant.compare = R"("mass3.position": {"column": "y0", "unit": "m"})";
  plant.rate = [true_one](const Numbers& x, double u, const Numbers&) {
    const double f1 = 900 * x[0] + 4 * x[1];
    const double f2 = true_one.k2 * (x[0] - x[2]) + 2 * (x[1] - x[3]);
    const double f3 = 1100 * (x[2] - x[4]) + 2 * (x[3] - x[5]);
    return Numbers{x[1], u - f1 - f2, x[3], (f2 - f3) / true_one.m2, x[5], f3 / 0.8};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[4]}; };
  plant.input = [steps = random_steps(0.13, 3)](double t) { return 20 * steps(t); };
  plant.initial = Numbers(6), plant.measurement_noise = {2e-5};
  plant.sample_time = 2.5e-3, plant.rows = 2000;
  return plant;
}

void expect_moved(const Diagnosis& d, const std::string& name, double value) {
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_TRUE(d.effects.empty()) << to_text(d);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  EXPECT_EQ(d.moved_parameters[0].name, name);
  EXPECT_NEAR(d.moved_parameters[0].value, value, 0.01 * value);
}

/// With all nine free, masses, springs and dampers may be scaled together.
TEST(OneParameter, ASpringIsNamedByItself) { expect_moved(diagnosed(chain({.k2 = 1150})), "k2", 1150); }
/// It scales two forces, which are no effects.
TEST(OneParameter, AMassIsNamedByItself) { expect_moved(diagnosed(chain({.m2 = 1.8})), "m2", 1.8); }
TEST(OneParameter, NothingIsWhereNothingIsWrong) {
  const Diagnosis d = diagnosed(chain({}));
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
  EXPECT_TRUE(d.moved_parameters.empty()) << to_text(d);
}

}  // namespace
}  // namespace loopwright::one_parameter_test
