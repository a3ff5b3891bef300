// A law of motion that is multiplied by one number is the same law, and the answer says so.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::common_factor_test {
namespace {

using testing::Contains, testing::Field, testing::HasSubstr, testing::Not;

auto finds(const char* words) { return Contains(Field(&RecordFinding::what, HasSubstr(words))); }

WantedMotion motion() {
  WantedMotion wanted = there_and_back(0.2, 0.4);
  const WantedMotion more = there_and_back(0.25, 0.3);
  wanted.position.insert(wanted.position.end(), more.position.begin(), more.position.end());
  return wanted;
}

/// A spring of the diagram that is a fifth too stiff: input, mass and damping would be a fifth more.
TEST(CommonFactor, AForceThatTheDiagramStatesTooStrongIsTold) {
  HiddenMachine machine;
  machine.further_blocks =
      R"("spring": {"type": "Spring", "stiffness": {"value": 36, "unit": "N/m"}, "in": {"position": "mass.position"}},
    "resists": {"type": "Sum", "signs": "++", "in": {"terms": ["viscous.force", "spring.force"]}},)";
  machine.damping_port = "resists.sum";
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.spring_n_per_m = 30;
  const std::string record = axis.record("spring", truth, motion());
  const Diagnosis d = diagnose(axis.diagram(), {record});
  EXPECT_THAT(names(d), testing::UnorderedElementsAre("force_gain", "inertia", "viscous_friction"));
  EXPECT_THAT(d.findings, finds("input, mass and damping are")) << to_text(d);
}

/// Pounds of force taken for newtons.
TEST(CommonFactor, AnInputOfAnotherUnitIsSuspected) {
  HiddenMachine machine;
  machine.newtons_per_column = 4.448;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.3;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("pounds", truth, motion())});
  EXPECT_THAT(d.findings, finds("the input acts 4.4")) << to_text(d);
  EXPECT_THAT(d.other_explanations, Contains(Field(&OtherExplanation::effects,
                                                   testing::ElementsAre("inertia", "viscous_friction"))))
      << to_text(d);
}

TEST(CommonFactor, TwoNumbersThatAreWrongByThemselvesAreNot) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.added_mass_kg = 0.3 * truth.mass_kg, truth.added_damping_n_s_per_m = -0.2 * truth.damping_n_s_per_m;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("two", truth, motion())});
  EXPECT_THAT(d.findings, Not(finds("times what is stated"))) << to_text(d);
}

}  // namespace
}  // namespace loopwright::common_factor_test
