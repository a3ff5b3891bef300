// What an answer itself leaves open.
#include <gmock/gmock.h>
#include "tools/diagnose/verdict/open_answers.h"

namespace loopwright::open_answers_test {
namespace {

using namespace diagnosis;

DiagnosedEffect effect(std::string name, std::string form = "") {
  DiagnosedEffect e;
  e.name = std::move(name), e.form = std::move(form);
  return e;
}

TEST(OpenAnswers, ASensorBesideADragMayBeAnInertiaThatChangesAlongTheWay) {
  Diagnosis d;
  d.effects = {effect("sensor_nonlinearity"), effect("direction_dependent_friction", "drag")};
  EXPECT_THAT(why_sensor_is_open(d), testing::HasSubstr("an inertia or a force constant that changes"));
  d.effects[1].form = "dry friction";  // of another law
  EXPECT_EQ(why_sensor_is_open(d), "");
  d.effects.pop_back();
  EXPECT_EQ(why_sensor_is_open(d), "");
}

TEST(OpenAnswers, EffectsOfWhichNoneIsNecessaryMustNotSpoilTheBalance) {
  Diagnosis d;
  d.steps.resize(2);
  d.steps[1].is_optional = true;
  d.error_before = 1, d.error_after = 1.4;
  EXPECT_THAT(why_optional_effects_are_open(d), testing::HasSubstr("1.40 times"));
  d.error_after = 1.1;
  EXPECT_EQ(why_optional_effects_are_open(d), "");
  d.error_after = 1.4, d.steps[1].is_optional = false;
  EXPECT_EQ(why_optional_effects_are_open(d), "");
  d.steps.resize(1);
  EXPECT_EQ(why_optional_effects_are_open(d), "") << "nothing was named";
}

}  // namespace
}  // namespace loopwright::open_answers_test
