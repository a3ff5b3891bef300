// Two records together determine what neither determines alone.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::several_records_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

TEST(SeveralRecords, OneForwardAndOneBackwardNameCoulombFriction) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const std::string forward = axis.record("forward", truth, one_way_without_rest(1));
  const std::string backward = axis.record("backward", truth, one_way_without_rest(-1));
  for (const std::string& alone : {forward, backward}) {
    const Diagnosis d = diagnose(axis.diagram(), {alone});
    ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
    EXPECT_THAT(d.effects[0].alternatives, Not(IsEmpty())) << to_text(d);
    EXPECT_EQ(d.findings.at(0).what, "all motion goes one way");
  }
  const Diagnosis d = diagnose(axis.diagram(), {forward, backward});
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_THAT(d.effects[0].alternatives, IsEmpty()) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.15, 0.005, "N");
  EXPECT_THAT(d.experiments, ElementsAre(forward, backward));
}

/// A constant force and Coulomb friction together: each direction alone shows only their sum or their
/// difference.
TEST(SeveralRecords, OneForwardAndOneBackwardTellTwoEffectsWithTheirNumbers) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15, truth.offset_n = 0.1;
  const std::string forward = axis.record("forward", truth, one_way(1));
  const std::string backward = axis.record("backward", truth, one_way(-1));
  for (const std::string& alone : {forward, backward})
    EXPECT_EQ(diagnose(axis.diagram(), {alone}).effects.size(), 1u);
  for (const auto& order : {std::vector{forward, backward}, std::vector{backward, forward}}) {
    const Diagnosis d = diagnose(axis.diagram(), order);
    ASSERT_THAT(names(d), ElementsAre("coulomb_friction", "constant_force")) << to_text(d);
    expect_parameter(d.effects[0], "level", 0.15, 0.005, "N");
    expect_parameter(d.effects[1], "level", 0.1, 0.005, "N");
  }
}

/// A spindle that turns at constant speed: dry friction, damping and a constant force cannot be
/// distinguished.
TEST(SeveralRecords, OneSlowBackwardAndOneFastForwardNameCoulombFriction) {
  HiddenMachine machine;
  machine.leaves_out_s = 1;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const auto turning = [](double speed) {
    WantedMotion motion;
    motion.initial_speed = speed;
    while (motion.position.size() < 5000) motion.position.push_back(motion.position.back() + 1e-3 * speed);
    return motion;
  };
  const std::string forward = axis.record("forward", truth, turning(0.4));
  const std::string backward = axis.record("backward", truth, turning(-0.15));
  for (const std::string& alone : {forward, backward}) {
    const Diagnosis d = diagnose(axis.diagram(), {alone});
    ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
    EXPECT_THAT(d.effects[0].alternatives, Not(IsEmpty())) << to_text(d);
  }
  const Diagnosis d = diagnose(axis.diagram(), {forward, backward});
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_THAT(d.effects[0].alternatives, IsEmpty()) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.15, 0.005, "N");
}

/// Held out as a whole, a record judges what the other one says.
TEST(SeveralRecords, AWholeRecordCanBeHeldOut) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.2, truth.cogging = {0.1, 0.024, 0.3};
  const std::string fitted = axis.record("fitted", truth, there_and_back(0.2, 0.4));
  const std::string judge = axis.record("judge", truth, there_and_back(0.15, 0.3));
  std::ifstream in(judge);
  std::string text(std::istreambuf_iterator<char>(in), {});
  text.insert(text.rfind('}'), R"(, "hold_out": {"fraction": 1})");
  std::ofstream(judge) << text;
  const Diagnosis d = diagnose(axis.diagram(), {fitted, judge}), alone = diagnose(axis.diagram(), {fitted});
  ASSERT_EQ(names(d), names(alone)) << to_text(d);
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "cogging")) << to_text(d);
  EXPECT_TRUE(d.holds_out);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_NEAR(d.held_out_mean_square, 1, 0.15);
  EXPECT_LT(d.error_after, 0.2 * d.error_before);
  EXPECT_THROW(diagnose(axis.diagram(), {judge}), InputError);
}

TEST(SeveralRecords, NothingIsMissingWhenNeitherLacksAnything) {
  HiddenAxis axis;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("forward", axis.nominal(), one_way(1)),
                                                axis.record("backward", axis.nominal(), one_way(-1))});
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
  EXPECT_NEAR(d.mean_square, 1, 0.06);
}

}  // namespace
}  // namespace loopwright::several_records_test
