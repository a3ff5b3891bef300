// What moves with the axis when it is set to another place, and what does not.
#include <gtest/gtest.h>
#include <vector>
#include "tests/engine/written_diagram.h"
#include "tools/compare/joined_bodies.h"

namespace loopwright::joined_bodies_test {
namespace {

/// States by the port that shows them, after the motor was moved by 2 and is faster by 3.
double moved(const Plan& plan, const std::string& port, const std::string& position = "motor.position") {
  std::vector<double> states(size_t(plan.states), 0.0);
  carry_along(plan, plan.find(position).at(0), plan.find("motor.velocity").at(0), 2, 3, states.data());
  return states.at(size_t(plan.find(port).at(0) - plan.signals));
}

std::string with_load(const std::string& coupling) {
  return diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
 "motor": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "push.y"}},
 "load": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "coupling.force"}},
 "next": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "further.force"}},
 "other": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "push.y"}},
 "coupling": )" + coupling +
                 R"(,
 "further": {"type": "ElasticCoupling", "stiffness": 10, "damping": 1, "in": {"motor_position": "load.position",
  "motor_velocity": "load.velocity", "load_position": "next.position", "load_velocity": "next.velocity"}})");
}

constexpr const char* elastic =
    R"({"type": "ElasticCoupling", "stiffness": 10, "damping": 1, "in": {"motor_position": "motor.position",
  "motor_velocity": "motor.velocity", "load_position": "load.position", "load_velocity": "load.velocity"}})";

TEST(JoinedBodies, AreCarriedAlongOneBehindTheOther) {
  const auto plan = plan_of(with_load(elastic));
  for (const char* body : {"load", "next"}) {
    EXPECT_EQ(moved(*plan, std::string(body) + ".position"), 2) << body;
    EXPECT_EQ(moved(*plan, std::string(body) + ".velocity"), 3) << body;
  }
}

TEST(JoinedBodies, OtherBodiesAndTheAxisItselfStay) {
  const auto plan = plan_of(with_load(elastic));
  for (const char* port : {"other.position", "other.velocity", "motor.position", "motor.velocity"})
    EXPECT_EQ(moved(*plan, port), 0) << port;
}

/// A table behind a gear turns by another angle.
TEST(JoinedBodies, BehindAGearStay) {
  const auto plan = plan_of(diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N*m"}},
 "motor": {"type": "Inertia", "inertia": 1, "in": {"torque": "push.y"}},
 "table": {"type": "Inertia", "inertia": 1, "in": {"torque": "gear.output_torque"}},
 "gear": {"type": "Gear", "ratio": 50, "stiffness": 10, "damping": 1, "in": {"input_angle": "motor.angle",
  "input_velocity": "motor.velocity", "output_angle": "table.angle", "output_velocity": "table.velocity"}})"));
  EXPECT_EQ(moved(*plan, "table.angle", "motor.angle"), 0);
  EXPECT_EQ(moved(*plan, "table.velocity", "motor.angle"), 0);
}

}  // namespace
}  // namespace loopwright::joined_bodies_test
