#include "engine/lanes/lane_run.h"
#include <gmock/gmock.h>
#include <set>
#include "engine/block.h"
#include "tests/engine/lanes/lane_testing.h"
#include "where.h"

namespace loopwright::lane_run_test {
namespace {

/// A block that is in no module, like one from a block library: counts the calls of decide.
struct DecisionCounter {
  struct In {
    double u;
  };
  struct Out {
    double decisions;
  };
  struct Mode {
    double decisions;
  };
  static constexpr auto describe() {
    return block("Counts decisions.", input(&In::u, "u", "$u", "Where it stands in the order"),
                 output(&Out::decisions, "decisions", "", "How many so far"));
  }
  void decide(const In&, Mode& mode) const { mode.decisions += 1; }
  void outputs(const In&, const Mode& mode, Out& out) const { out.decisions = mode.decisions; }
};
LOOPWRIGHT_BLOCK(DecisionCounter)

using namespace loopwright::testing;
using ::testing::HasSubstr;

class LaneRunTest : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { SKIP_WITHOUT_LANES(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Sets, LaneRunTest, ::testing::ValuesIn(simd_sets), set_name);

const char* const division = R"({
  "loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "one":   {"type": "Constant", "value": 1},
    "ramp":  {"type": "Ramp", "slope": -1, "initial": 0.5},
    "ratio": {"type": "Product", "operations": "*/", "in": {"factors": ["one.y", "ramp.y"]}}
  },
  "log": ["ratio.product"]
})";

TEST_P(LaneRunTest, StopsOnlyTheLaneWhoseBlockFaults) {
  const auto plan = plan_of(division);
  const auto run = make_lane_run(*plan, GetParam(), 2);
  for (int lane = 0; lane < run->lanes(); ++lane)
    ASSERT_TRUE(set_parameter(*run, "ramp.initial", lane, lane == 5 ? 0.5 : 2.0 + lane));
  run->reset({});
  run->run();
  EXPECT_EQ(run->failed(), uint64_t(1) << 5);
  EXPECT_THAT(to_text(run->failure(5), *plan), HasSubstr("\"ratio\" stopped the run at t = 0.5"));
  EXPECT_THAT(to_text(run->failure(5), *plan), HasSubstr("division by zero"));
  const Number ratio = plan->find("ratio.product")[0];
  EXPECT_EQ(number(*run, ratio, 4), 1 / (6.0 - 1.0));
}

TEST_P(LaneRunTest, ReportsEachLaneWithItsOwnTime) {
  const auto plan = plan_of(division);
  const auto run = make_lane_run(*plan, GetParam(), 1);
  for (int lane = 0; lane < run->lanes(); ++lane)
    set_parameter(*run, "ramp.initial", lane, lane == 1 ? 0.25 : lane == 3 ? 0.75 : 2.0);
  run->reset({});
  run->run();
  EXPECT_EQ(run->failed(), uint64_t(0b1010));
  EXPECT_NEAR(run->failure(1).time, 0.25, 0.02);
  EXPECT_NEAR(run->failure(3).time, 0.75, 0.02);
  set_parameter(*run, "ramp.initial", 1, 2.0);
  run->reset({});
  EXPECT_EQ(run->failed(), 0u);
  run->run();
  EXPECT_EQ(run->failed(), uint64_t(0b1000));
}

TEST_P(LaneRunTest, StopsEarlyWhenAllLanesHaveFailed) {
  const auto plan = plan_of(division);
  const auto run = make_lane_run(*plan, GetParam(), 1);
  run->run();
  EXPECT_EQ(run->failed(), ~uint64_t(0) >> (64 - run->lanes()));
  EXPECT_LT(run->time(), 0.6);
}

TEST_P(LaneRunTest, NamesTheSignalThatDivergesInALane) {
  const auto plan = plan_of(R"({
    "loopwright": 1, "solver": {"method": "euler", "step": 0.5, "stop": 2000},
    "blocks": {"speed": {"type": "Gain", "gain": -1, "in": {"u": "place.y"}},
               "place": {"type": "Integrator", "initial": 1, "in": {"u": "speed.y"}}},
    "log": ["place.y"]})");
  const auto run = make_lane_run(*plan, GetParam(), 1);
  ASSERT_TRUE(set_parameter(*run, "speed.gain", 2, -9.0));
  run->reset({});
  run->run();
  EXPECT_EQ(run->failed(), uint64_t(0b100));
  EXPECT_THAT(to_text(run->failure(2), *plan), HasSubstr("the run diverged: \""));
  EXPECT_LT(run->failure(2).time, 1000);
}

// If a jump in one lane made the others decide again, their counts would differ from those of scalar runs.
TEST_P(LaneRunTest, LetsALaneJumpWithoutTouchingTheDecisionsOfOthers) {
  const auto plan = plan_of(R"({
    "loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 10},
    "blocks": {
      "kick":  {"type": "Sine", "amplitude": 1, "frequency": 7},
      "place": {"type": "Integrator", "in": {"u": "kick.y", "reset": "kick.y", "reset_value": "kick.y"}},
      "count": {"type": "DecisionCounter", "in": {"u": "place.y"}}
    },
    "log": ["place.y", "count.decisions"]})");
  const auto parameters = tunable_parameters(*plan);
  const auto lanes = lane_rows(*plan, parameters, GetParam(), 2);
  std::set<double> counts;
  for (int lane = 0; lane < int(lanes.size()); ++lane) {
    EXPECT_EQ(difference(*plan, scalar_rows(*plan, parameters, lane), lanes[size_t(lane)]), "")
        << "lane " << lane;
    counts.insert(lanes[size_t(lane)].values.back());
  }
  EXPECT_GT(counts.size(), 1u);
}

// The lanes jump at different instants, at some of which there is an edge of the trigger too.
TEST_P(LaneRunTest, KeepsATriggerWhereALaneJumps) {
  const auto plan = plan_of(R"({
    "loopwright": 1, "solver": {"method": "rk4", "step": 0.1, "stop": 10},
    "blocks": {
      "t":     {"type": "PulseTrain", "period": 2, "width": 1, "start": 1, "sample_time": 0.1},
      "half":  {"type": "Constant", "value": {"value": 0.5, "unit": "s"}},
      "place": {"type": "Integrator", "in": {"u": "t.y", "reset": "t.y", "reset_value": "half.y"}},
      "count": {"diagram": {"inputs": {"u": "1"}, "outputs": {"y": "d.y"}, "blocks": {
                 "d": {"type": "DiscreteIntegrator", "method": "backward", "sample_time": 0.1, "in": {"u": "u"}}}},
                "triggered_by": "t.y", "in": {"u": "t.y"}}
    },
    "log": ["place.y", "count.y"]})");
  EXPECT_NEAR(scalar_rows(*plan, {}, 0).values.back(), 0.5, 1e-12) << "five edges, each a sample of 0.1 s";
  const auto parameters = tunable_parameters(*plan);
  const auto lanes = lane_rows(*plan, parameters, GetParam(), 2);
  for (int lane = 0; lane < int(lanes.size()); ++lane)
    EXPECT_EQ(difference(*plan, scalar_rows(*plan, parameters, lane), lanes[size_t(lane)]), "") << lane;
}

// Each lane needs a different number of Newton steps.
TEST_P(LaneRunTest, SolvesRingsLaneByLane) {
  const auto plan = plan_of(diagram(R"(
    "drive": {"type": "Sine", "amplitude": 1, "frequency": 1},
    "sum":   {"type": "Sum", "signs": "+-", "in": {"terms": ["drive.y", "soft.force"]}},
    "soft":  {"type": "SmoothCoulombFriction", "level": 0.5, "transition_speed": 0.1, "in": {"velocity": "sum.sum"}})",
                                    R"("method": "rk4", "step": 0.01, "stop": 1, "algebraic_loops": "solve")",
                                    R"(, "log": ["sum.sum"])"));
  ASSERT_FALSE(plan->algebraic_loops.empty());
  const auto parameters = tunable_parameters(*plan);
  const auto lanes = lane_rows(*plan, parameters, GetParam(), 2);
  for (int lane = 0; lane < int(lanes.size()); ++lane)
    EXPECT_EQ(difference(*plan, scalar_rows(*plan, parameters, lane), lanes[size_t(lane)]), "") << lane;
}

TEST_P(LaneRunTest, GivesEachLaneTheNoiseOfItsOwnRun) {
  const auto plan = plan_of(R"({"loopwright": 1, "solver": {"stop": 0.1},
    "blocks": {"noise": {"type": "Noise", "sample_time": 0.01, "standard_deviation": 1}}, "log": ["noise.y"]})");
  const auto run = make_lane_run(*plan, GetParam(), 2);
  run->reset({plan->seed, 40});
  run->run();
  loopwright::Run<double> scalar(*plan);
  const Number y = plan->find("noise.y")[0];
  for (int lane = 0; lane < run->lanes(); ++lane) {
    scalar.reset({plan->seed, 40 + lane});
    while (scalar.now().tick < plan->stop_tick) scalar.step_fixed(plan->stop_tick, true, [] {});
    scalar.evaluate(scalar.due(), true);
    EXPECT_EQ(number(*run, y, lane), scalar.number(y)) << lane;
  }
}

TEST_P(LaneRunTest, RepeatsItselfAfterReset) {
  const auto plan = fixed_step_plan(LOOPWRIGHT_SOURCE "/diagrams/linear_motor/common_job.json");
  const auto run = make_lane_run(*plan, GetParam(), 1);
  const Number position = plan->find("stage.position")[0];
  run->run();
  const double first = number(*run, position, 2);
  run->reset({plan->seed, 0});
  EXPECT_EQ(number(*run, position, 2), 0.0);
  run->run();
  EXPECT_EQ(number(*run, position, 2), first);
  EXPECT_NE(first, 0.0);
}

TEST_P(LaneRunTest, EndsWhenARowIsTheLastThatIsWanted) {
  const auto plan = plan_of(division);
  const auto run = make_lane_run(*plan, GetParam(), 1);
  int rows = 0;
  run->run([&](double) { return ++rows < 3; });
  EXPECT_EQ(rows, 3);
  EXPECT_LT(run->time(), 0.05);
}

TEST_P(LaneRunTest, RefusesParametersThatAreStructuralOrUnknown) {
  const auto plan = plan_of(division);
  const auto run = make_lane_run(*plan, GetParam(), 1);
  EXPECT_FALSE(set_parameter(*run, "ratio.operations", 0, 1));
  EXPECT_FALSE(set_parameter(*run, "ramp.slop", 0, 1));
  EXPECT_FALSE(set_parameter(*run, "nobody.slope", 0, 1));
}

TEST_P(LaneRunTest, RefusesMoreLanesThanAMaskHolds) {
  const auto plan = plan_of(division);
  EXPECT_EQ(make_lane_run(*plan, GetParam(), 64 / lanes_in_arena(GetParam()))->lanes(), 64);
  EXPECT_THROW(make_lane_run(*plan, GetParam(), 3), std::runtime_error);
  EXPECT_THROW(make_lane_run(*plan, GetParam(), 0), std::runtime_error);
}

/// A block that counts its decisions, though it says that the one before does not matter.
template <class Real> struct Tally {
  static constexpr bool decides_anew = true;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real count;
  };
  static constexpr auto describe() {
    return block("Counts.", input(&In::u, "u", "", "Not used"), output(&Out::y, "y", "", "The count"));
  }
  void decide(const In&, Mode& mode) const { mode.count = mode.count + 1.0; }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.count; }
};
LOOPWRIGHT_BLOCK(Tally)

TEST_P(LaneRunTest, ADecisionAnewBeginsWithAnEmptyMode) {
  const auto plan = plan_of(diagram(R"("one": {"type": "Constant", "value": 1},
    "tally": {"type": "Tally", "in": {"u": "one.y"}})"));
  const auto run = make_lane_run(*plan, GetParam(), 1);
  const Number tally = plan->find("tally.y").at(0);
  std::vector<double> count(size_t(run->lanes()));
  for (double time : {0.0, 0.1, 0.2}) {
    run->evaluate(time);
    run->read({&tally, 1}, count.data());
    for (double counted : count) EXPECT_EQ(counted, 1) << time;
  }
}

/// A block that would act on the outside world.
struct Lamp {
  static constexpr bool has_side_effects = true;
  struct In {
    double u;
  };
  struct Memory {
    double lit;
  };
  static constexpr auto describe() {
    return block("Lights a lamp.", input(&In::u, "u", "", "Whether it is lit"));
  }
  void update(const In& in, Memory& memory) const { memory.lit = in.u; }
};
LOOPWRIGHT_BLOCK(Lamp)

TEST(LanesForbiddenBy, NamesABlockWithSideEffects) {
  const auto plan = plan_of(diagram(R"("one": {"type": "Constant", "value": 1},
    "lamp": {"type": "Lamp", "sample_time": 0.1, "in": {"u": "one.y"}})"));
  EXPECT_THAT(lanes_forbidden_by(*plan), HasSubstr("\"lamp\""));
  EXPECT_THROW(make_lane_run(*plan, InstructionSet::scalar, 1), std::runtime_error);
}

TEST(LanesForbiddenBy, NamesAVariableStepMethodUnlessThereAreNoStates) {
  const std::string head =
      R"({"loopwright": 1, "solver": {"method": "dopri5", "stop": 1}, "blocks": {"one": {"type": "Constant", "value": 1})";
  const auto integral = plan_of(head + R"(, "integral": {"type": "Integrator", "in": {"u": "one.y"}}}})");
  EXPECT_THAT(lanes_forbidden_by(*integral), HasSubstr("dopri5"));
  EXPECT_EQ(lanes_forbidden_by(*plan_of(head + "}}")), "");
}

}  // namespace
}  // namespace loopwright::lane_run_test
