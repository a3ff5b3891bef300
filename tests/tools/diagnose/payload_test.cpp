// Records of one axis with known masses on it: "set" in their experiments.
#include <gmock/gmock.h>
#include <cstdlib>
#include <fstream>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/compare/several.h"

namespace loopwright::payload_test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not,
    testing::UnorderedElementsAre;

constexpr double carriage_kg = 0.8, payload_kg = 0.5;

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

void insert(const std::string& path, const std::string& before, const std::string& text,
            bool at_end = false) {
  std::string whole = text_of(path);
  const size_t at = at_end ? whole.rfind(before) : whole.find(before);
  ASSERT_NE(at, whole.npos) << before;
  whole.insert(at, text);
  std::ofstream(path) << whole;
}

HiddenMachine with_mass(const std::string& settings) {
  HiddenMachine machine;
  machine.mass = carriage_kg;
  machine.moving =
      fmt::format(R"("mass": {{"type": "Mass", {}, "in": {{"force": "net_force.sum"}}}})", settings);
  return machine;
}

/// How the diagram states the payload, and how a record does.
struct Wording {
  std::string settings, parameters, set;
};
const Wording setting_of_a_mass{R"("mass": {"value": 0.8, "unit": "kg"})", "",
                                R"("mass.payload": {"value": 0.5, "unit": "kg"})"};
const Wording parameter_in_a_sum{
    R"("mass": "=carriage + payload")",
    R"("carriage": {"value": 0.8, "unit": "kg"}, "payload": {"value": 0, "unit": "kg"})",
    R"("payload": "=0.5")"};

class LoadedAxis {
 public:
  explicit LoadedAxis(Wording wording = setting_of_a_mass)
      : wording_(std::move(wording)), axis_(with_mass(wording_.settings)), truth(axis_.nominal()) {
    if (!wording_.parameters.empty())
      insert(axis_.diagram(), "\"blocks\"", fmt::format("\"parameters\": {{{}}},\n  ", wording_.parameters));
  }
  std::string diagram() const { return axis_.diagram(); }
  std::string file(const std::string& name) const { return axis_.file(name); }
  std::string record(const std::string& name, double payload, bool is_told = true) {
    Physics loaded = truth;
    loaded.added_mass_kg += payload;
    const std::string path = axis_.record(name, loaded, there_and_back(way_m, top_speed_m_per_s));
    if (payload > 0 && is_told) insert(path, "}", fmt::format(", \"set\": {{{}}}", wording_.set), true);
    return path;
  }
  std::vector<std::string> empty_and_loaded(bool is_told = true) {
    return {record("empty", 0), record("loaded", payload_kg, is_told)};
  }
  Diagnosis diagnosed(const std::vector<std::string>& records, const DiagnoseOptions& options = {}) const {
    const Diagnosis d = diagnose(diagram(), records, options);
    if (getenv("SHOW_DIAGNOSES")) {
      for (const std::string& line : d.trail) puts(line.c_str());
      puts(to_text(d).c_str());
    }
    return d;
  }

 private:
  const Wording wording_;
  HiddenAxis axis_;

 public:
  Physics truth;
  double way_m = 0.2, top_speed_m_per_s = 0.4;
};

/// Hidden beside a motor that gives 5 % less: the friction of a bearing and of a seal.
void hide_a_weak_motor(Physics& truth) {
  truth.gain = -0.05, truth.added_damping_n_s_per_m = 1, truth.coulomb_n = 0.3;
}

TEST(Payload, TellsAGainFromAMass) {
  for (const Wording& wording : {setting_of_a_mass, parameter_in_a_sum}) {
    LoadedAxis axis(wording);
    hide_a_weak_motor(axis.truth);
    const Diagnosis d = axis.diagnosed(axis.empty_and_loaded());
    EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
    ASSERT_THAT(names(d), UnorderedElementsAre("force_gain", "viscous_friction", "coulomb_friction"))
        << to_text(d);
    for (const DiagnosedEffect& effect : d.effects) {
      EXPECT_THAT(effect.alternatives, IsEmpty()) << effect.name << to_text(d);
      if (effect.name == "force_gain") expect_parameter(effect, "gain_error", -0.05, 0.01, "1");
      if (effect.name == "viscous_friction") expect_parameter(effect, "damping", 1, 0.1, "N*s/m");
      if (effect.name == "coulomb_friction") expect_parameter(effect, "level", 0.3, 0.02, "N");
    }
  }
}

TEST(Payload, AMassThatAllRecordsLackIsCalledInertia) {
  for (const Wording& wording : {setting_of_a_mass, parameter_in_a_sum}) {
    LoadedAxis axis(wording);
    axis.truth.added_mass_kg = 0.06, axis.truth.coulomb_n = 0.3;
    const Diagnosis d = axis.diagnosed(axis.empty_and_loaded());
    EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
    ASSERT_THAT(names(d), UnorderedElementsAre("inertia", "coulomb_friction")) << to_text(d);
    for (const DiagnosedEffect& effect : d.effects)
      if (effect.name == "inertia") expect_parameter(effect, "mass", 0.06, 0.01, "N*s^2/m");
  }
}

TEST(Payload, NothingIsMissingIfTheRecordsStateTheirMasses) {
  LoadedAxis axis;
  const Diagnosis d = axis.diagnosed(axis.empty_and_loaded());
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
}

TEST(Payload, ThatIsNotToldIsNoExplanation) {
  LoadedAxis axis;
  axis.way_m = 0.08;
  hide_a_weak_motor(axis.truth);
  const Diagnosis d = axis.diagnosed(axis.empty_and_loaded(false));
  EXPECT_NE(d.verdict, Verdict::nothing_missing) << to_text(d);
  EXPECT_NE(d.verdict, Verdict::explained) << to_text(d);
}

TEST(Payload, AWholeMassThatARecordStatesIsKnown) {
  LoadedAxis axis(
      {R"("mass": {"value": 0.8, "unit": "kg"})", "", R"("mass.mass": {"value": 1.3, "unit": "kg"})"});
  axis.truth.coulomb_n = 0.3;
  const Diagnosis d = axis.diagnosed(axis.empty_and_loaded());
  EXPECT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  const auto left_out = std::ranges::find_if(d.not_looked_for, [](const NotLookedFor& entry) {
    return std::ranges::find(entry.effects, "inertia") != entry.effects.end();
  });
  ASSERT_NE(left_out, d.not_looked_for.end()) << to_text(d);
  EXPECT_THAT(left_out->why, HasSubstr("states \"mass.mass\", which is then known"));
}

/// What is written holds for all records; each brings its own mass along.
TEST(Payload, TheImprovedDiagramHasNoRecordsOwnValues) {
  LoadedAxis axis(parameter_in_a_sum);
  axis.truth.added_mass_kg = 0.06, axis.truth.coulomb_n = 0.3;
  const std::vector<std::string> records = axis.empty_and_loaded();
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis d = axis.diagnosed(records, options);
  ASSERT_EQ(d.improved, options.improved_diagram) << to_text(d);
  EXPECT_THAT(text_of(d.improved), HasSubstr(R"("payload": {"value": 0, "unit": "kg"})"));
  const auto& experiments = d.improved_experiments.empty() ? records : d.improved_experiments;
  for (const Comparison& c : compare(d.improved, experiments).records) {
    ASSERT_TRUE(c.force) << c.why_no_force;
    EXPECT_LT(c.force->residual.rmse, 1.25 * c.force->residual.noise_floor);
  }
  for (const DiagnosisStep& step : d.steps) EXPECT_TRUE(std::isfinite(step.simulation_rmse));
}

TEST(Payload, ARecordWithAnotherPayloadJudgesWhatIsHeldOut) {
  LoadedAxis axis;
  axis.truth.coulomb_n = 0.3;
  const std::string fitted = axis.record("fitted", 0), judge = axis.record("judge", payload_kg);
  insert(judge, "}", R"(, "hold_out": {"fraction": 1})", true);
  const Diagnosis d = axis.diagnosed({fitted, judge});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_NEAR(d.held_out_mean_square, 1, 0.15);
}

class WithoutRoles : public testing::Test {
 protected:
  std::vector<std::string> records() {
    axis.way_m = 0.08;
    std::vector<std::string> list = axis.empty_and_loaded();
    for (const std::string& path : list) {
      std::string text = text_of(path);
      const size_t from = text.find("\"roles\""), to = text.find("}", from);
      text.replace(from, to + 1 - from, R"("sites": ["net_force.sum"])");
      std::ofstream(path) << text;
    }
    return list;
  }
  LoadedAxis axis{parameter_in_a_sum};
};

TEST_F(WithoutRoles, APayloadTellsAGainFromAMass) {
  IS_A_JUDGEMENT();
  axis.truth.gain = -0.05, axis.truth.coulomb_n = 0.3;
  const Diagnosis d = axis.diagnosed(records());
  ASSERT_THAT(names(d), ElementsAre("sign")) << to_text(d);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  EXPECT_EQ(d.moved_parameters[0].name, "motor.gain");
  EXPECT_NEAR(d.moved_parameters[0].value, 0.95, 0.005);
  EXPECT_THAT(d.other_explanations, IsEmpty()) << to_text(d);
}

TEST_F(WithoutRoles, AMassThatAllRecordsLackIsThatOfTheCarriage) {
  IS_A_JUDGEMENT();
  axis.truth.added_mass_kg = 0.06, axis.truth.coulomb_n = 0.3;
  const Diagnosis d = axis.diagnosed(records());
  ASSERT_THAT(names(d), ElementsAre("sign")) << to_text(d);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  EXPECT_EQ(d.moved_parameters[0].name, "carriage");
  EXPECT_NEAR(d.moved_parameters[0].value, carriage_kg + 0.06, 0.005);
}

}  // namespace
}  // namespace loopwright::payload_test
