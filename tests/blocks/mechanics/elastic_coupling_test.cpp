#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::elastic_coupling_test {

TEST(ElasticCoupling, PullsByDeflectionAndItsSpeed) {
  BlockUnderTest coupling("ElasticCoupling", R"({"stiffness": 100, "damping": 2})");
  coupling.input("motor_position") = 0.5, coupling.input("load_position") = 0.2;
  coupling.input("motor_velocity") = 1, coupling.input("load_velocity") = 4;
  coupling.evaluate();
  EXPECT_NEAR(coupling.output("force"), 100 * 0.3 - 2 * 3, 1e-12);
}

TEST(ElasticCoupling, TwoMassesOnItMoveAsTheBlockOfTwoMasses) {
  const RunResult result = run_of(diagram(
      R"("push": {"type": "Sine", "amplitude": {"value": 1, "unit": "N"}, "frequency": 3},
         "on_motor": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "coupling.force"]}},
         "motor": {"type": "Mass", "mass": 0.3, "in": {"force": "on_motor.sum"}},
         "coupling": {"type": "ElasticCoupling", "stiffness": 500, "damping": 1,
                      "in": {"motor_position": "motor.position", "motor_velocity": "motor.velocity",
                             "load_position": "load.position", "load_velocity": "load.velocity"}},
         "load": {"type": "Mass", "mass": 0.1, "in": {"force": "coupling.force"}},
         "one": {"type": "TwoMass", "motor_mass": 0.3, "load_mass": 0.1, "stiffness": 500, "damping": 1,
                 "in": {"force": "push.y"}})",
      R"("method": "rk4", "step": 0.001, "stop": 1)", R"(, "log": ["load.position", "one.load_position"])"));
  const auto &two = signal(result, "load.position"), &one = signal(result, "one.load_position");
  for (size_t i = 0; i < two.size(); ++i) EXPECT_NEAR(two[i], one[i], 1e-12) << i;
}

}  // namespace loopwright::elastic_coupling_test
