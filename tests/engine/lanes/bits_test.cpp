/// Lanes give the bits of scalar runs, for every block and every diagram, whatever the lanes' parameters.
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include "tests/engine/lanes/lane_testing.h"
#include "where.h"

namespace loopwright::bits_test {
namespace {

using namespace loopwright::testing;

const std::string diagrams = LOOPWRIGHT_SOURCE "/diagrams/";

/// Every diagram that can run by itself, without experiments and models beside them.
std::vector<std::string> all_diagrams() {
  std::vector<std::string> names;
  for (const char* folder : {"axis", "emps", "examples", "linear_motor"})
    for (const auto& file : std::filesystem::directory_iterator(diagrams + folder)) {
      const std::string name = file.path().filename();
      if (file.path().extension() != ".json" || file.path().stem().has_extension()) continue;
      Problems problems;
      const auto diagram = load_diagram(file.path(), {}, problems);
      // Parts of other diagrams have inputs of their own or no stop time. Examples must run.
      const bool runs = diagram && diagram->inputs.empty() && diagram->solver.stop.is_given;
      if (runs || folder == std::string("examples")) names.push_back(std::string(folder) + "/" + name);
    }
  std::sort(names.begin(), names.end());
  return names;
}

class EveryDiagram : public ::testing::TestWithParam<std::string> {};

/// One in every register of four lanes, and therefore two in every register of eight, at a different position
/// in each.
std::vector<int> lanes_in_every_register() {
  std::vector<int> lanes;
  for (int i = 0; i < most_lanes / 4; ++i) lanes.push_back(4 * i + i % 4);
  return lanes;
}

TEST_P(EveryDiagram, GivesTheBitsOfScalarRunsInEveryRegister) {
  const auto plan = fixed_step_plan(diagrams + GetParam());
  const std::string forbidden = lanes_forbidden_by(*plan);
  if (forbidden.ends_with("acts on the world outside, one run at a time")) GTEST_SKIP() << forbidden;
  ASSERT_EQ(forbidden, "");
  const auto parameters = tunable_parameters(*plan);
  std::map<int, Rows> scalar;
  for (const InstructionSet set : simd_sets) {
    if (!lanes_unavailable(set).empty()) continue;
    const auto lanes = lane_rows(*plan, parameters, set, most_lanes / lanes_in_arena(set));
    for (const int lane : lanes_in_every_register()) {
      if (!scalar.contains(lane)) scalar[lane] = scalar_rows(*plan, parameters, lane);
      EXPECT_FALSE(scalar[lane].failed) << "there is nothing to compare";
      ASSERT_GT(scalar[lane].values.size(), plan->log.size() + 1);
      EXPECT_EQ(difference(*plan, scalar[lane], lanes[size_t(lane)]), "")
          << to_name(set) << ", lane " << lane;
    }
  }
  EXPECT_EQ(difference(*plan, scalar_rows(*plan, parameters, 0),
                       lane_rows(*plan, parameters, InstructionSet::scalar, 1)[0]),
            "");
}
INSTANTIATE_TEST_SUITE_P(Diagrams, EveryDiagram, ::testing::ValuesIn(all_diagrams()),
                         [](const auto& diagram) {
                           std::string name = diagram.param.substr(0, diagram.param.rfind('.'));
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(AllDiagrams, ReachEveryBlock) {
  std::set<std::string> missing;
  for (const auto& [type, block] : all_blocks())
    if (!block.info.source.starts_with("blocks/further/")) missing.insert(type);
  for (const std::string& name : all_diagrams()) {
    const auto plan = fixed_step_plan(diagrams + name);
    for (const Plan::Block& block : plan->blocks) missing.erase(block.type->info.type);
  }
  std::string text;
  for (const std::string& type : missing) text += type + " ";
  EXPECT_EQ(text, "") << "no diagram runs these on lanes";
}

TEST(AllDiagrams, HaveParametersThatTellLanesApart) {
  const auto plan = fixed_step_plan(diagrams + "linear_motor/common_job.json");
  const auto parameters = tunable_parameters(*plan);
  EXPECT_GT(parameters.size(), 20u);
  std::set<double> shares, positions;
  for (int lane = 0; lane < 4; ++lane) {
    for (const TunedParameter& parameter : parameters)
      if (parameter.value != 0) shares.insert(std::round(1e4 * parameter.in_lane(lane) / parameter.value));
    positions.insert(std::round(1e5 * scalar_rows(*plan, parameters, lane).values.back()));
  }
  EXPECT_GT(shares.size(), parameters.size());
  EXPECT_EQ(positions.size(), 4u);
}

class EverySet : public ::testing::TestWithParam<InstructionSet> {};

TEST_P(EverySet, RunsEveryBlockButPlainStructsOnItsOwnKernels) {
  SKIP_WITHOUT_LANES(GetParam());
  for (const std::string& name : all_diagrams()) {
    const auto plan = fixed_step_plan(diagrams + name);
    if (!lanes_forbidden_by(*plan).empty()) continue;  // as tested above
    const auto run = make_lane_run(*plan, GetParam(), 1);
    for (size_t b = 0; b < plan->blocks.size(); ++b)
      EXPECT_EQ(run->is_lane_wise(int(b)), plan->blocks[b].type->info.lane_wise && plan->blocks[b].gate < 0)
          << plan->blocks[b].path;  // each lane has its own moments at which a gate is open
  }
}
const char* const sources = R"({
  "loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 1},
  "blocks": {
    "chirp":  {"type": "Chirp", "amplitude": 2, "from": 1, "to": 9, "duration": 0.4, "repeats": true},
    "many":   {"type": "Multisine", "band": {"from": 1, "to": 20, "count": 5, "amplitude": 0.3}},
    "motion": {"type": "MotionProfile", "start": 0.1, "segments": [{"duration": 0.3, "velocity": 1},
                                                                   {"duration": 0.3, "velocity": 0}]},
    "noise":  {"type": "Noise", "sample_time": 0.01, "standard_deviation": 1},
    "pulses": {"type": "PulseTrain", "period": 0.13, "width": 0.05},
    "ramp":   {"type": "Ramp", "slope": 3, "start": 0.2, "stop": 0.7},
    "sine":   {"type": "Sine", "amplitude": 2, "frequency": 3},
    "step":   {"type": "Step", "time": 0.5},
    "sum":    {"type": "Sum", "in": {"terms": ["chirp.y", "many.y", "motion.velocity", "noise.y", "pulses.y",
                                               "ramp.y", "sine.y", "step.y"]}},
    "area":   {"type": "Integrator", "in": {"u": "sum.sum"}}
  }
})";

TEST_P(EverySet, GivesTheSameBitsWhereNobodyAskedForAParameterOfASource) {
  SKIP_WITHOUT_LANES(GetParam());
  const auto plan = plan_of(sources);
  const auto untouched = lane_rows(*plan, {}, GetParam(), 2);
  auto parameters = tunable_parameters(*plan);
  std::erase_if(parameters, [](const TunedParameter& p) { return !p.path.starts_with("ramp."); });
  const auto touched = lane_rows(*plan, parameters, GetParam(), 2);
  for (const int lane : {0, 13, 31, 32, 63}) {
    EXPECT_EQ(difference(*plan, scalar_rows(*plan, {}, lane), untouched[size_t(lane)]), "");
    EXPECT_EQ(difference(*plan, scalar_rows(*plan, parameters, lane), touched[size_t(lane)]), "");
  }
}
INSTANTIATE_TEST_SUITE_P(Sets, EverySet, ::testing::ValuesIn(simd_sets), set_name);

}  // namespace
}  // namespace loopwright::bits_test
