// The diagram that a diagnosis writes, run on the record: it has the error that the staircase promises.
#include <gmock/gmock.h>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "engine/json/json.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/compare/compare.h"

namespace loopwright::improved_diagram_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// The residual force of the written diagram on the record, with the experiment that goes with it.
double residual_of(const Diagnosis& d, const std::string& experiment) {
  const std::string with = d.improved_experiments.empty() ? experiment : d.improved_experiments.front();
  const Comparison c = compare(d.improved, with);
  EXPECT_TRUE(c.force) << c.why_no_force;
  return c.force ? c.force->residual.rmse : 0;
}

Diagnosis written(const HiddenAxis& axis, const std::string& experiment, bool all = true) {
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json"), options.writes_all = all;
  return diagnose(axis.diagram(), {experiment}, options);
}

/// The experiment drives "motor.u", before which the delay stands: without the experiment that is written
/// beside the diagram it would bypass it.
TEST(ImprovedDiagram, HasTheErrorThatIsPromisedWithEffectsOfForceInputAndSensor) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.2, truth.delay_s = 3e-3;
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  const Diagnosis d = written(axis, record);
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "input_delay")) << to_text(d);
  ASSERT_THAT(d.improved_experiments, SizeIs(1)) << to_text(d);
  EXPECT_EQ(d.improved_experiments[0], axis.file("improved.record.experiment.json"));
  EXPECT_NEAR(residual_of(d, record), d.steps.back().force_rmse, 0.1 * d.steps.back().force_rmse)
      << to_text(d);
  const Comparison bypassed = compare(d.improved, record);
  EXPECT_GT(bypassed.force->residual.rmse, 1.5 * d.steps.back().force_rmse) << "with the old experiment";
  EXPECT_THAT(d.taken_out_by, testing::UnorderedElementsAre("with_coulomb_friction", "with_input_delay"));
  const Comparison nominal = compare(d.improved, d.improved_experiments[0],
                                     {.set = {{"with_coulomb_friction", "0"}, {"with_input_delay", "0"}}});
  EXPECT_NEAR(nominal.force->residual.rmse, d.steps.front().force_rmse, 0.1 * d.steps.front().force_rmse);
}

/// A bump on the track is in no effect file.
TEST(ImprovedDiagram, ContainsAnUnknownFunctionAsALookupWithItsRange) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.bump_n = 1, truth.bump_m = 0.1, truth.bump_width_m = 0.015;
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  const Diagnosis d = written(axis, record);
  EXPECT_THAT(d.remainder_variables, Contains("position")) << to_text(d);
  std::ifstream in(d.improved);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  EXPECT_THAT(text, HasSubstr("Lookup1D"));
  EXPECT_THAT(text, HasSubstr("\"outside\": \"hold\""));
  EXPECT_THAT(to_text(d), HasSubstr("beyond them its ends are held"));
  EXPECT_NEAR(residual_of(d, record), d.steps.back().force_rmse, 0.15 * d.steps.back().force_rmse)
      << to_text(d);
}

/// Something that gives way in the middle of a record, whose clock is that of the day.
TEST(ImprovedDiagram, StatesAForceThatJumpsAsAStepAtItsInstantByTheClockOfTheRecord) {
  HiddenMachine machine;
  machine.leaves_out_s = 0.15, machine.clock_s = 43200;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.step_n = -0.5, truth.step_s = 2.4134, truth.coulomb_n = 0.3;
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  const Diagnosis d = written(axis, record);
  EXPECT_THAT(names(d), testing::ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_THAT(d.remainder_variables, testing::ElementsAre("time")) << to_text(d);
  EXPECT_NEAR(d.effects[0].parameters[0].value, 0.3, 0.01) << to_text(d);
  std::ifstream in(d.improved);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const size_t step = text.find(R"("type": "Step", "time": )");
  ASSERT_NE(step, std::string::npos) << text;
  double instant = 0, level = 0;
  ASSERT_EQ(
      std::sscanf(text.c_str() + step, R"("type": "Step", "time": %lf, "after": %lf)", &instant, &level), 2)
      << text.substr(step, 100);
  EXPECT_NEAR(instant, machine.clock_s + truth.step_s, hidden_sample_time);
  EXPECT_NEAR(level, truth.step_n, 0.02);
  EXPECT_THAT(to_text(d), HasSubstr("+ a force that jumps at 43202.41"));
  EXPECT_THAT(to_text(d), HasSubstr("is a step at 43202.41"));
  EXPECT_NEAR(residual_of(d, record), d.steps.back().force_rmse, 0.1 * d.steps.back().force_rmse)
      << to_text(d);
}

/// The machine is cold when the record begins, whatever its clock shows.
TEST(ImprovedDiagram, WarmsUpFromTheBeginningOfTheRecord) {
  HiddenMachine machine;
  machine.clock_s = 600;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.drift_of = DRIFT_OF_OFFSET, truth.drift = 0.6, truth.drift_time_s = 4;
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  const Diagnosis d = written(axis, record);
  EXPECT_THAT(names(d), testing::ElementsAre("thermal_drift")) << to_text(d);
  EXPECT_NEAR(residual_of(d, record), d.steps.back().force_rmse, 0.15 * d.steps.back().force_rmse)
      << to_text(d);
}

/// What is written without --all is the diagram of the last step that is not optional.
TEST(ImprovedDiagram, LeavesOptionalEffectsOutUnlessAllAreWanted) {
  HiddenMachine machine;
  machine.force_noise = 0.03;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.6, truth.cogging = {0.03, 0.024, 0.3};
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  const Diagnosis few = written(axis, record, false);
  ASSERT_GE(few.steps.size(), 3u) << to_text(few);
  ASSERT_TRUE(few.steps.back().is_optional) << to_text(few);
  size_t last = few.steps.size() - 1;
  while (few.steps[last].is_optional) --last;
  EXPECT_NEAR(residual_of(few, record), few.steps[last].force_rmse, 0.1 * few.steps[last].force_rmse);
  EXPECT_THAT(few.taken_out_by, Not(Contains("with_cogging")));
  EXPECT_THAT(to_text(few), HasSubstr("fit best without them")) << "the numbers above are those of all";
  const Diagnosis all = written(axis, record, true);
  EXPECT_NEAR(residual_of(all, record), all.steps.back().force_rmse, 0.1 * all.steps.back().force_rmse);
  EXPECT_THAT(all.taken_out_by, Contains("with_cogging"));
  EXPECT_THAT(to_text(all), Not(HasSubstr("optional effects are not in it")));
}

}  // namespace
}  // namespace loopwright::improved_diagram_test
