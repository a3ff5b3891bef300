// The diagram that a diagnosis without roles writes: it loads, states all units, and simulates the record.
#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "engine/plan/plan.h"
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plants.h"
#include "tools/compare/compare.h"

namespace loopwright::any_diagram_improved_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class Written {
 public:
  explicit Written(const Plant& plant) : files(plant) {
    DiagnoseOptions options;
    options.improved_diagram = beside("improved.json");
    answer = diagnose(files.diagram(), {files.experiment()}, options);
  }
  std::string beside(const std::string& name) const {
    return (std::filesystem::path(files.diagram()).parent_path() / name).string();
  }
  /// The first compared signal's error of a simulation along the whole record.
  double simulated(const LoadOptions& options = {}) const {
    const auto& list = answer.improved_experiments;
    return error_of(answer.improved, list.empty() ? files.experiment() : list.front(), options);
  }
  double simulated_before() const { return error_of(files.diagram(), files.experiment(), {}); }
  nlohmann::json blocks() const {
    std::ifstream in(answer.improved);
    return nlohmann::json::parse(in)["blocks"];
  }

  RecordedPlant files;
  Diagnosis answer;

 private:
  static double error_of(const std::string& diagram, const std::string& experiment,
                         const LoadOptions& options) {
    return compare(diagram, experiment, options).signals.front().rmse;
  }
};

void expect_all_units(const std::string& path) {
  Problems problems;
  const auto diagram = load_diagram(path, {}, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  EXPECT_EQ(problems.text(), "");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->without_unit.count, 0u) << to_string(plan->without_unit);
}

TEST(AnyDiagramImproved, HasTheTermAtItsSumAndTheParameterThatMoved) {
  Tanks m;
  m.lost = [](double level, double) { return 0.02 * std::max(0.0, level - 0.5); };
  m.second_outlet = 0.0055;
  const Written w(tanks(m, 3));
  ASSERT_THAT(names(w.answer), ElementsAre("overflow")) << to_text(w.answer);
  expect_all_units(w.answer.improved);
  EXPECT_THAT(w.answer.taken_out_by, ElementsAre("with_overflow_at_balance1"));
  EXPECT_THAT(w.answer.improved_experiments, IsEmpty());
  EXPECT_THAT(to_text(w.answer), HasSubstr("takes one effect out of"));
  EXPECT_EQ(w.blocks()["balance1"]["in"]["terms"].back(), "overflow_at_balance1_share.y");
  EXPECT_EQ(w.blocks()["balance1"]["signs"], "+-+");
  const double before = w.simulated_before(), with = w.simulated();
  EXPECT_LT(with, 0.3 * before);
  const double without =
      w.simulated({.set = {{"with_overflow_at_balance1", "0"}, {"second_outlet", "0.005"}}});
  EXPECT_NEAR(without, before, 1e-6 * before);
}
TEST(AnyDiagramImproved, AWireOfASumThatIsDrivenMayHaveAnotherGain) {
  Plant plant = tanks({}, 5);
  plant.drive = R"("balance1.terms[0]": {"column": "u", "unit": "m^3/s"})";
  plant.input = [volts = plant.input](double t) { return 1e-3 * volts(t); };
  plant.rate = [rate = plant.rate](const Numbers& x, double u, const Numbers& w) {
    return rate(x, 0.9 * u / 1e-3, w);
  };
  const Written w(plant);
  ASSERT_THAT(names(w.answer), ElementsAre("linear")) << to_text(w.answer);
  expect_all_units(w.answer.improved);
  EXPECT_THAT(w.answer.improved_experiments, SizeIs(1)) << "the wire is now that of a Gain in front of it";
  EXPECT_LT(w.simulated(), 0.3 * w.simulated_before());
}
TEST(AnyDiagramImproved, ADistortionOfTheInputStandsBeforeItAndTheExperimentFollows) {
  const Written w(valve({.dead_zone = 0.13}, 1));
  ASSERT_THAT(names(w.answer), ElementsAre("dead_zone")) << to_text(w.answer);
  expect_all_units(w.answer.improved);
  ASSERT_THAT(w.answer.improved_experiments, SizeIs(1)) << "the experiment drives command.u";
  EXPECT_THAT(w.answer.experiment_ports.front().to, ElementsAre("command_input.u"));
  EXPECT_EQ(w.blocks()["command"]["in"]["u"], "dead_zone_at_command_sum.sum");
  EXPECT_LT(w.simulated(), 0.1 * w.simulated_before());
}
TEST(AnyDiagramImproved, ALateInputStandsBesideWhatItReads) {
  Plant plant = motor({}, 62);
  plant.delay = 2.4e-3, plant.rows = 1200;
  const Written w(plant);
  ASSERT_THAT(names(w.answer), ElementsAre("delay")) << to_text(w.answer);
  expect_all_units(w.answer.improved);
  EXPECT_EQ(w.blocks()["delay_at_amplifier"]["type"], "TransportDelay");
  EXPECT_THAT(w.answer.taken_out_by, ElementsAre("with_delay_at_amplifier"));
  EXPECT_LT(w.simulated(), 0.2 * w.simulated_before());
  EXPECT_NEAR(w.simulated({.set = {{"with_delay_at_amplifier", "0"}}}), w.simulated_before(),
              1e-6 * w.simulated_before());
}
TEST(AnyDiagramImproved, ALagOfAnAmplifierIsAnActuator) {
  IS_A_JUDGEMENT();
  const Written w(lagging_motor(3e-3, 61));
  ASSERT_THAT(names(w.answer), ElementsAre("lag")) << to_text(w.answer);
  EXPECT_EQ(w.answer.effects[0].site, "amplifier.u");
  EXPECT_EQ(w.answer.verdict, Verdict::explained);
  EXPECT_NEAR(w.answer.effects[0].parameters.at(0).value, 3e-3, 0.005 * 3e-3);
  expect_all_units(w.answer.improved);
  EXPECT_EQ(w.blocks()["lag_at_amplifier"]["type"], "ActuatorLag");
  EXPECT_LT(w.simulated(), 0.2 * w.simulated_before());
}
TEST(AnyDiagramImproved, ATermAtAPortThatIsDrivenStandsBesideWhatDrivesIt) {
  const Written w(
      heated_plate([](double t, double) { return 6e-10 * (std::pow(t, 4) - std::pow(293.15, 4)); }, 7));
  ASSERT_THAT(names(w.answer), Contains("radiation")) << to_text(w.answer);
  EXPECT_THAT(w.answer.moved_parameters, IsEmpty()) << to_text(w.answer);
  EXPECT_EQ(w.answer.effects[0].site, "plate.heat");
  EXPECT_EQ(w.answer.verdict, Verdict::explained) << to_text(w.answer);
  ASSERT_EQ(w.answer.improved_experiments.size(), 1u);
  expect_all_units(w.answer.improved);
  EXPECT_LT(w.simulated(), 0.2 * w.simulated_before());
}
TEST(AnyDiagramImproved, ACouplingActsOnBothSides) {
  Tanks m;
  m.spilled = [](double level, double) { return 0.03 * std::max(0.0, level - 0.5); };
  const Written w(tanks(m, 4));
  ASSERT_THAT(names(w.answer), ElementsAre("overflow")) << to_text(w.answer);
  ASSERT_EQ(w.answer.effects[0].site, "outlet1.y");
  expect_all_units(w.answer.improved);
  EXPECT_EQ(w.blocks()["balance1"]["in"]["terms"][1], "overflow_at_outlet1_sum.sum");
  EXPECT_EQ(w.blocks()["balance2"]["in"]["terms"][0], "overflow_at_outlet1_sum.sum");
  EXPECT_LT(w.simulated(), 0.3 * w.simulated_before());
}
TEST(AnyDiagramImproved, AFunctionWithoutANameIsALookup) {
  Oscillator m;
  m.force = [](double x, double) { return 3 * std::exp(-std::pow((x - 0.03) / 0.015, 2)); };
  const Written w(oscillator(m, 5));
  ASSERT_THAT(names(w.answer), ElementsAre("unknown")) << to_text(w.answer);
  EXPECT_THAT(w.answer.remainder_variables, ElementsAre("mass.position"));
  EXPECT_EQ(w.answer.verdict, Verdict::partly_explained);
  expect_all_units(w.answer.improved);
  EXPECT_EQ(w.blocks()["unknown_at_net"]["type"], "Lookup1D");
  EXPECT_THAT(w.answer.improved_notes, SizeIs(1));
  EXPECT_LT(w.simulated(), 0.2 * w.simulated_before());
}
TEST(AnyDiagramImproved, WithoutAnythingMissingTheDiagramIsTheSame) {
  const Written w(tanks({}, 1));
  ASSERT_EQ(w.answer.verdict, Verdict::nothing_missing);
  EXPECT_EQ(w.simulated(), w.simulated_before());
}

}  // namespace
}  // namespace loopwright::any_diagram_improved_test
