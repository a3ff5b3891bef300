#include "tools/linearize/linear_diagram.h"
#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>
#include <cmath>
#include "tests/engine/written_diagram.h"

namespace loopwright::linear_diagram_test {
namespace {

using Eigen::MatrixXd;
using testing::ElementsAre;
using testing::HasSubstr;

const char* const mass_on_spring = R"(
  "drive": {"type": "Constant", "value": 0},
  "mass": {"type": "Mass", "mass": 2, "in": {"force": "sum.sum"}},
  "sum": {"type": "Sum", "signs": "+--", "in": {"terms": ["drive.y", "spring.force", "drag.force"]}},
  "spring": {"type": "Spring", "stiffness": 8, "in": {"position": "mass.position"}},
  "drag": {"type": "ViscousFriction", "damping": 0.5, "in": {"velocity": "mass.velocity"}})";

TEST(ContinuousPart, AMassOnASpringHasItsMatricesExactly) {
  const auto plan = plan_of(diagram(mass_on_spring));
  const LinearSystem system =
      continuous_part(linearize_at_start(*plan), {{"sum.terms[0]"}, {"mass.position", "mass.velocity"}, {}});
  EXPECT_THAT(system.states, ElementsAre("mass.position", "mass.velocity"));
  MatrixXd A(2, 2), B(2, 1);
  A << 0, 1, -4, -0.25;
  B << 0, 0.5;
  EXPECT_TRUE(system.matrices.A.isApprox(A, 1e-14)) << system.matrices.A;
  EXPECT_TRUE(system.matrices.B.isApprox(B, 1e-14)) << system.matrices.B;
  EXPECT_EQ(system.matrices.C, MatrixXd(MatrixXd::Identity(2, 2)));
  EXPECT_EQ(system.matrices.D, MatrixXd(MatrixXd::Zero(2, 1)));
}

TEST(ContinuousPart, ASignalAddedAtAnOutputReachesAllReadersAndAtAnInputOne) {
  const auto plan = plan_of(diagram(mass_on_spring));
  const LinearDiagram linear = linearize_at_start(*plan);
  EXPECT_EQ(continuous_part(linear, {{"spring.position"}, {"mass.position"}, {}}).matrices.B(1, 0), -4);
  EXPECT_EQ(continuous_part(linear, {{"mass.position"}, {"mass.position"}, {}}).matrices.B(1, 0), -4);
  EXPECT_EQ(continuous_part(linear, {{"mass.position"}, {"spring.force"}, {}}).matrices.D(0, 0), 8);
  EXPECT_EQ(continuous_part(linear, {{"mass.position"}, {"mass.position"}, {}}).matrices.D(0, 0), 0)
      << "what the block computes, before anything is added";
}

TEST(ContinuousPart, ACutWireNoLongerCloses) {
  const auto plan = plan_of(diagram(mass_on_spring));
  const LinearSystem open = continuous_part(linearize_at_start(*plan),
                                            {{"spring.position"}, {"mass.position"}, {"spring.position"}});
  EXPECT_EQ(open.matrices.A(1, 0), 0);
  EXPECT_EQ(open.matrices.B(1, 0), -4);
}

TEST(ContinuousPart, ARingOfDirectFeedthroughIsSolved) {
  const auto plan = plan_of(diagram(R"(
    "u": {"type": "Constant", "value": 1},
    "sum": {"type": "Sum", "signs": "+-", "in": {"terms": ["u.y", "gain.y"]}},
    "gain": {"type": "Gain", "gain": 3, "in": {"u": "sum.sum"}})",
                                    R"("stop": 1, "step": 0.1, "algebraic_loops": "solve")"));
  const LinearSystem system =
      continuous_part(linearize_at_start(*plan), {{"u.y"}, {"sum.sum", "gain.y"}, {}});
  EXPECT_NEAR(system.matrices.D(0, 0), 0.25, 1e-15);
  EXPECT_NEAR(system.matrices.D(1, 0), 0.75, 1e-15);
}

TEST(ContinuousPart, APendulumIsLinearWhereItStands) {
  const auto plan = plan_of(diagram(R"~(
    "torque": {"type": "Expression", "formula": "9.81*sin(x)", "names": ["x"],
               "in": {"arguments": ["mass.position"]}},
    "mass": {"type": "Mass", "mass": 1, "initial_position": 0.5, "in": {"force": "minus.y"}},
    "minus": {"type": "Gain", "gain": -1, "in": {"u": "torque.y"}})~"));
  const LinearSystem system = continuous_part(linearize_at_start(*plan), {});
  EXPECT_NEAR(system.matrices.A(1, 0), -9.81 * std::cos(0.5), 1e-9);
}

TEST(ContinuousPart, AtATimeOfARunItStandsWhereTheRunStands) {
  const auto plan = plan_of(diagram(R"(
    "one": {"type": "Constant", "value": 1},
    "x": {"type": "Integrator", "in": {"u": "one.y"}},
    "square": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}})"));
  const LinearDiagram linear = linearize_at(*plan, 0.7);
  EXPECT_DOUBLE_EQ(linear.time, 0.7);
  EXPECT_NEAR(continuous_part(linear, {{"x.y"}, {"square.product"}, {}}).matrices.D(0, 0), 1.4, 1e-11);
}

TEST(ContinuousPart, WhereInputAndOutputShareANameTheInputIsAskedForByItsKey) {
  const auto plan = plan_of(diagram(R"(
    "x": {"type": "Constant", "value": 1},
    "encoder": {"type": "Encoder", "resolution": 0, "in": {"position": "x.y"}},
    "gain": {"type": "Gain", "gain": 3, "in": {"u": "encoder.position"}})"));
  const LinearDiagram linear = linearize_at_start(*plan);
  const auto gain = [&](const char* from) {
    return continuous_part(linear, {{from}, {"encoder.position", "gain.y"}, {}}).matrices.D;
  };
  EXPECT_EQ(gain("encoder.in.position")(0, 0), 1);
  EXPECT_EQ(gain("encoder.position")(0, 0), 0);
  EXPECT_EQ(gain("encoder.position")(1, 0), 3);
}

TEST(ContinuousPart, PortsThatDoNotExistAreNamedAllAtOnce) {
  const auto plan = plan_of(diagram(mass_on_spring));
  try {
    continuous_part(linearize_at_start(*plan), {{"sum.therms"}, {"mass.positon"}, {}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("mass.positon"));
    EXPECT_THAT(e.what(), HasSubstr("sum.therms"));
    EXPECT_THAT(e.what(), HasSubstr("did you mean \"mass.position\""));
  }
}

}  // namespace
}  // namespace loopwright::linear_diagram_test
