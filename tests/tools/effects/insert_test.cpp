#include "tools/effects/insert.h"
#include "tools/effects/nest.h"
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <numeric>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "tests/engine/written_diagram.h"
#include "tests/tools/effects/amplified_mass.h"
#include "tests/tools/effects/axis_sizes.h"
#include "where.h"

namespace loopwright::insert_test {

namespace {

const InsertionSite nominal_axis{{{"position", "axis.position"},
                                  {"velocity", "axis.velocity"},
                                  {"force", "axis.net_force"},
                                  {"input", "axis.force"}},
                                 {},
                                 {}};

std::shared_ptr<const SourceFile> source(const std::string& path) {
  Problems problems;
  return read_source(path, {}, problems);
}
std::shared_ptr<const SourceFile> nominal() {
  return source(LOOPWRIGHT_SOURCE "/diagrams/axis/nominal.json");
}

RunResult run_text(const std::string& text, const std::string& path) {
  Problems problems;
  const Value root = parse_json(std::make_shared<SourceFile>(SourceFile{path, text}), problems);
  const auto diagram = read_diagram(root, path, {.set = {{"solver.record_step", "0.001"}}}, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  EXPECT_EQ(problems.text(), "") << text;
  return plan ? simulate(*plan) : RunResult{RunStatus::failed};
}

std::vector<double> values(const Effect& effect, bool zero) {
  std::vector<double> list;
  for (const EffectParameter& p : effect.parameters) {
    if (!p.is_fitted) continue;
    const FitRange range = range_of(p, axis_sizes());
    const double least = range.low > 0 ? range.low : 0;
    if (p.name == "place") {  // of an end stop: within the motion, or far beyond it
      list.push_back(!zero ? 0.001 : effect.form == "low end" ? -9 : 9);
      continue;
    }
    const bool is_size = (p.is_linear && effect.name != "end_stop") || p.unit == "s";
    list.push_back(zero && is_size ? least : range.start);
  }
  return list;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

std::string insert_text(std::shared_ptr<const SourceFile> file, const InsertionSite& site,
                        const Effect& effect, const std::vector<double>& fitted) {
  Problems problems;
  const auto insertion = insert_effect(file, site, effect, fitted, axis_sizes(), problems);
  EXPECT_EQ(problems.text(), "");
  return insertion ? insertion->text : "";
}

/// A mass of 1 kg and a damping of 3 N*s/m, written as given, pushed by 2 N.
std::string written_axis(const std::string& parameters, const std::string& mass, const std::string& damping) {
  return fmt::format(R"({{"loopwright": 1, "solver": {{"method": "rk4", "step": 0.001, "stop": 1}},
  "parameters": {{{}}}, "blocks": {{
    "push": {{"type": "Constant", "value": {{"value": 2, "unit": "N"}}}},
    "viscous": {{"type": "ViscousFriction", "damping": {}, "in": {{"velocity": "mass.velocity"}}}},
    "net": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["push.y", "viscous.force"]}}}},
    "mass": {{"type": "Mass", "mass": {}, "in": {{"force": "net.sum"}}}}}},
  "log": ["mass.velocity"]}})",
                     parameters, damping, mass);
}

/// The velocity after 1 s with 0.3 kg and 2 N*s/m more than is written.
void expect_more_mass_and_damping(const std::string& text) {
  DiagramFolder folder;
  folder.with("axis.json", text);
  const InsertionSite site{{{"position", "mass.position"}, {"force", "net.sum"}}, {}, {}};
  auto file = source(folder.path("axis.json"));
  for (const auto& [name, add] : {std::pair{"inertia", 0.3}, {"viscous_friction", 2.0}})
    file = std::make_shared<SourceFile>(
        SourceFile{file->name, insert_text(file, site, effect_named(name), {add})});
  const RunResult result = run_text(file->text, file->name);
  ASSERT_EQ(result.status, RunStatus::finished) << file->text;
  EXPECT_NEAR(signal(result, "mass.velocity").back(), 2.0 / 5 * (1 - std::exp(-5 / 1.3)), 1e-6) << file->text;
}

/// Lines of `b` that are not in `a`.
std::string new_lines(const std::string& a, const std::string& b) {
  std::istringstream lines(b);
  std::string line, result;
  while (std::getline(lines, line))
    if (a.find(line) == a.npos) result += line + "\n";
  return result;
}

}  // namespace

TEST(Insertion, EveryEffectRunsInTheNominalAxisAndChangesIt) {
  const auto file = nominal();
  const RunResult before = run_text(file->text, file->name);
  for (const Effect& effect : whole_catalogue()) {
    const RunResult after =
        run_text(insert_text(file, nominal_axis, effect, values(effect, false)), file->name);
    ASSERT_EQ(after.status, RunStatus::finished) << effect.name << ": " << after.message;
    EXPECT_GT(rms_difference(signal(before, "axis.position"), signal(after, "axis.position")), 1e-9)
        << effect.name << " " << effect.form;
  }
}

TEST(Insertion, AnEffectOfNoSizeChangesNothing) {
  const auto file = nominal();
  const RunResult before = run_text(file->text, file->name);
  for (const Effect& effect : whole_catalogue()) {
    if (effect.name == "backlash" || effect.name == "flexible_mode") continue;  // no mass, no load
    const RunResult after =
        run_text(insert_text(file, nominal_axis, effect, values(effect, true)), file->name);
    if (effect.name == "dead_band" || effect.form == "amplifier" || effect.form == "soft")
      continue;  // a limit has no small size
    // A lag cannot be zero, and a delayed command is sampled.
    const bool is_small = effect.name == "actuator_lag" || effect.name == "input_delay";
    const double allowed = is_small ? 2e-4 : 1e-12;
    EXPECT_LE(rms_difference(signal(before, "axis.position"), signal(after, "axis.position")), allowed)
        << effect.name << " " << effect.form;
  }
}

TEST(Insertion, IsAFewLinesInTheUsersOwnForm) {
  DiagramFolder folder;
  folder.with("top.json", R"({
  "loopwright": 1,
  "solver": {"method": "rk4", "step": 0.0001, "stop": 1},
  "blocks": {
    "push":      {"type": "Sine", "amplitude": {"value": 2, "unit": "N"}, "frequency": 2},
    "net_force": {"type": "Sum", "signs": "+", "in": {"terms": ["push.y"]}},
    "mass":      {"type": "Mass", "mass": 0.5, "in": {"force": "net_force.sum"}}
  },
  "log": ["mass.position"]
}
)");
  const auto file = source(folder.path("top.json"));
  const InsertionSite site{{{"position", "mass.position"}, {"force", "net_force.sum"}}, {}, {}};
  const std::string text = insert_text(file, site, effect_named("constant_force"), {0.25});
  EXPECT_EQ(new_lines(file->text, text),
            "    \"constant_force\": {\"type\": \"ConstantForce\", \"level\": 0.25},\n"
            "    \"net_force\": {\"type\": \"Sum\", \"signs\": \"+-\", \"in\": {\"terms\": [\"push.y\", "
            "\"constant_force.force\"]}},\n");
  EXPECT_EQ(run_text(text, file->name).status, RunStatus::finished);
}

TEST(Insertion, ASampledDelayKeepsInStepWithRowsOfAnyPeriod) {
  RecordSizes sizes = axis_sizes();
  sizes.sample_time = 1.0 / 750;
  Problems problems;
  const auto insertion =
      insert_effect(nominal(), nominal_axis, effect_named("input_delay"), {6e-4}, sizes, problems);
  ASSERT_TRUE(insertion) << problems.text();
  EXPECT_THAT(insertion->text, testing::HasSubstr("\"sample_time\": 0.0013333333333333333"));
}

TEST(Insertion, InASubdiagramLeavesTheFileOfTheOthersAlone) {
  const auto file = nominal();
  const std::string text = insert_text(file, nominal_axis, effect_named("coulomb_friction"), {0.12});
  EXPECT_TRUE(has(text, R"("coulomb_friction": {"type": "PreslidingFriction", "level": 0.12)")) << text;
  EXPECT_TRUE(has(text, R"("signs": "+--")")) << text;
  EXPECT_TRUE(has(text, R"("parameters": {"mass": "=mass", "damping": "=damping"},)")) << text;
  EXPECT_FALSE(has(text, "plants/axis.json")) << text;
}

TEST(Insertion, TwoOfAKindStandBesideEachOther) {
  const auto file = nominal();
  const Effect cogging = effect_named("cogging");
  const std::string once = insert_text(file, nominal_axis, cogging, {0.0225, 0.1, 0});
  const auto again = std::make_shared<SourceFile>(SourceFile{file->name, once});
  const std::string twice = insert_text(again, nominal_axis, cogging, {0.01, 0, 0.2});
  EXPECT_TRUE(has(twice, R"("cogging_2": {)")) << twice;
  const RunResult result = run_text(twice, file->name);
  EXPECT_EQ(result.status, RunStatus::finished);
}

TEST(Insertion, SeveralForcesOfOneEffectShareOneListOfSigns) {
  for (const std::string signs : {"", R"("signs": "+", )"}) {
    std::string text = written_axis("", "1", "0");
    const std::string before = R"("signs": "+-", "in": {"terms": ["push.y", "viscous.force"]})";
    text.replace(text.find(before), before.size(), signs + R"("in": {"terms": ["push.y"]})");
    DiagramFolder folder;
    folder.with("axis.json", text);
    Effect twice = effect_named("constant_force");
    twice.attachments.push_back(twice.attachments.front());
    const InsertionSite site{{{"position", "mass.position"}, {"force", "net.sum"}}, {}, {}};
    const auto file = source(folder.path("axis.json"));
    const std::string with = insert_text(file, site, twice, {0.5});
    const RunResult result = run_text(with, file->name);
    ASSERT_EQ(result.status, RunStatus::finished) << with;
    EXPECT_NEAR(signal(result, "mass.velocity").back(), 2 - 2 * 0.5, 1e-6) << with;
  }
}

TEST(Insertion, WhatCanBeSetAfterwardsIsNamed) {
  Problems problems;
  const auto file = nominal();
  const auto insertion =
      insert_effect(file, nominal_axis, effect_named("inertia"), {0.07}, axis_sizes(), problems);
  ASSERT_TRUE(insertion) << problems.text();
  ASSERT_EQ(insertion->settings.size(), 1u);
  EXPECT_EQ(insertion->settings[0].second, "axis.inertia_mass");
  EXPECT_TRUE(has(insertion->text, R"("mass": "=mass + inertia_mass")")) << insertion->text;
  EXPECT_TRUE(has(insertion->text, R"({"value": 0.07, "unit": "kg", "description": "More or)"))
      << insertion->text;
}

/// The diagram has no parameters of these names.
TEST(Insertion, AFormulaTakesTheParametersOfTheEffectAlong) {
  DiagramFolder folder;
  folder.with("power.json",
              R"({"loopwright": 1, "effect": "power", "title": "Power law", "physics": "A test.",
  "parameters": {
    "level": {"unit": "$force", "linear": true, "range": [0, "=3*force_level"], "start": "=0.1*force_level"},
    "exponent": {"unit": "1", "range": [0.5, 3], "start": 1.5},
    "reference": {"unit": "$position/s", "value": "=top_speed"}},
  "blocks": {"law": {"type": "Expression", "formula": "level*share*sign(v)*abs(v/reference)^exponent", "names": ["v"],
             "constants": [{"name": "share", "value": 0.5}], "in": {"arguments": ["velocity"]}}},
  "attach": [{"to": "force", "from": "law.y"}], "needs": {"text": "many speeds"}})");
  Problems problems;
  const std::vector<Effect> effects = load_effect(folder.path("power.json"), problems);
  ASSERT_EQ(effects.size(), 1u) << problems.text();
  const auto insertion =
      insert_effect(nominal(), nominal_axis, effects[0], {0.3, 1.5}, axis_sizes(), problems);
  ASSERT_TRUE(insertion) << problems.text();
  EXPECT_TRUE(has(insertion->text, R"({"name": "level", "value": 0.3, "unit": "N"})")) << insertion->text;
  EXPECT_TRUE(has(insertion->text, R"({"name": "share", "value": 0.5})")) << insertion->text;
  EXPECT_EQ(run_text(insertion->text, nominal()->name).status, RunStatus::finished);
  const std::pair<std::string, std::string> exponent{"exponent", "axis.power.constants.3.value"};
  EXPECT_NE(std::ranges::find(insertion->settings, exponent), insertion->settings.end());
}

TEST(Insertion, ForAnotherFolderPathsStillLeadToTheirFiles) {
  DiagramFolder folder;
  const std::string text = moved_to_folder(*nominal(), folder.path("deep/er"));
  folder.with("deep/er/moved.json", text);
  EXPECT_EQ(folder.problems("deep/er/moved.json"), "");
}

TEST(Insertion, SaysWhatIsMissing) {
  Problems problems;
  EXPECT_FALSE(insert_effect(nominal(), {{{"force", "axis.position"}}, {}, {}},
                             effect_named("constant_force"), {1}, axis_sizes(), problems));
  EXPECT_TRUE(has(problems.text(), "leads to no sum of forces")) << problems.text();
  Problems second;
  EXPECT_FALSE(
      insert_effect(nominal(), {{}, {}, {}}, effect_named("constant_force"), {1}, axis_sizes(), second));
  EXPECT_TRUE(has(second.text(), "no role \"force\"")) << second.text();
}

/// A controlled axis: the controller and the compared signals see the error of a sensor, forces do not.
TEST(Insertion, AnErrorOfTheSensorIsSeenOutsideAndNotByForces) {
  DiagramFolder folder;
  folder.with("axis.json", R"({"loopwright": 1, "inputs": {"force": "N"},
    "outputs": {"position": "mass.position", "net_force": "net_force.sum"},
    "blocks": {"spring": {"type": "Spring", "stiffness": 3, "in": {"position": "mass.position"}},
               "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["force", "spring.force"]}},
               "mass": {"type": "Mass", "mass": 1, "in": {"force": "net_force.sum"}}}})");
  folder.with("top.json", R"({"loopwright": 1, "solver": {"step": 0.001, "stop": 1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "axis": {"diagram": "axis.json", "in": {"force": "push.y"}}},
    "log": ["axis.position", "axis.mass.position"]})");
  const InsertionSite site{{{"position", "axis.position"}, {"force", "axis.net_force"}}, {}, {}};
  const auto file = source(folder.path("top.json"));
  const RunResult before = run_text(file->text, file->name);
  const RunResult after =
      run_text(insert_text(file, site, effect_named("encoder_periodic_error"), {0.01, 0.001, 0}), file->name);
  EXPECT_EQ(signal(before, "axis.position"), signal(after, "axis.mass.position"));
  EXPECT_GT(rms_difference(signal(after, "axis.position"), signal(after, "axis.mass.position")), 1e-4);
}

/// An observer that reads the command still reads the command, not the output of a lag.
TEST(Insertion, OnTheInputOnlyTheMachineFeelsIt) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "solver": {"step": 0.0001, "stop": 0.1}, "blocks": {
    "push": {"type": "Step", "time": 0, "before": {"value": 0, "unit": "N"}, "after": 1},
    "watch": {"type": "Gain", "gain": 1, "in": {"u": "push.y"}},
    "net_force": {"type": "Sum", "in": {"terms": ["push.y"]}},
    "mass": {"type": "Mass", "mass": 1, "in": {"force": "net_force.sum"}}},
    "log": ["watch.y", "mass.velocity"]})");
  const InsertionSite site{
      {{"position", "mass.position"}, {"force", "net_force.sum"}, {"input", "push.y"}}, {}, {}};
  const auto file = source(folder.path("top.json"));
  const RunResult after = run_text(insert_text(file, site, effect_named("actuator_lag"), {0.01}), file->name);
  EXPECT_EQ(signal(after, "watch.y").back(), 1);
  EXPECT_NEAR(signal(after, "mass.velocity").back(), 0.1 - 0.01 * (1 - std::exp(-10)), 1e-6);
}

/// The added number has the unit that is written beside it.
TEST(Insertion, AddsToASettingInTheUnitOfTheDiagram) {
  const std::string grams = R"("m": {"value": 5, "unit": "mm"}, "mass": {"value": 1000, "unit": "g"})";
  const std::string per_mm = R"("damping": {"value": 0.003, "unit": "N*s/mm"})";
  expect_more_mass_and_damping(written_axis(grams + ", " + per_mm, R"("=mass")", R"("=damping")"));
  expect_more_mass_and_damping(written_axis(grams + ", " + per_mm, R"("=1*mass")", R"("=2*damping/2")"));
  expect_more_mass_and_damping(
      written_axis("", R"({"value": 1000, "unit": "g"})", R"({"value": 0.003, "unit": "N*s/mm"})"));
  expect_more_mass_and_damping(written_axis("", "1", "3"));
}

TEST(Insertion, AddsToAnExpressionBesideAUnit) {
  expect_more_mass_and_damping(written_axis(R"("mass": {"value": 1000, "unit": "g"}, "damping": 0.003)",
                                            R"({"value": "=mass", "unit": "kg"})",
                                            R"({"value": "=damping", "unit": "N*s/mm"})"));
}

/// Names are compared as a whole: "m" is no part of "mass".
TEST(Insertion, AddsToAnExpressionInTheUnitOfItsOwnNames) {
  expect_more_mass_and_damping(
      written_axis(R"("m": {"value": 5, "unit": "g"}, "mass": {"value": 1, "unit": "kg"},
                      "d": {"value": 0.003, "unit": "N*s/mm"}, "damping": {"value": 3, "unit": "N*s/m"},
                      "length": {"value": 2, "unit": "m"}, "density": {"value": 0.5, "unit": "kg/m"})",
                   R"("=density*length")", R"("=damping")"));
  expect_more_mass_and_damping(written_axis(
      R"("m": {"value": 5, "unit": "g"}, "mass": {"value": 1, "unit": "kg"})", R"("=mass")", "3"));
  expect_more_mass_and_damping(
      written_axis(R"("m": {"value": 5, "unit": "g"}, "mass": 1)", R"("=mass")", R"("=6/2")"));
}

/// An experiment that drives the port before which an effect stands would bypass it.
TEST(Insertion, NamesThePortsThatReadTheInputFromNowOn) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "solver": {"step": 0.001, "stop": 0.1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "net": {"type": "Sum", "in": {"terms": ["push.y"]}},
    "mass": {"type": "Mass", "mass": 1, "in": {"force": "net.sum"}}},
    "log": ["mass.velocity"]})");
  const InsertionSite site{{{"force", "net.sum"}, {"input", "push.y"}}, {}, {}};
  Problems problems;
  const auto insertion = insert_effect(source(folder.path("top.json")), site, effect_named("force_gain"),
                                       {0.1}, axis_sizes(), problems);
  ASSERT_TRUE(insertion) << problems.text();
  ASSERT_EQ(insertion->input_at.size(), 1u);
  EXPECT_EQ(insertion->input_at[0].from, "net.terms[0]");
  EXPECT_EQ(insertion->input_at[0].to, std::vector<std::string>{"force_gain.u"});
}

/// The second effect of the input acts behind the first: the first one's port reaches both.
TEST(Insertion, ASecondEffectOfTheInputIsReachedThroughTheFirst) {
  DiagramFolder folder;
  folder.with("top.json", amplified_mass);
  const InsertionSite site{{{"force", "net.sum"}, {"input", "amp.u"}}, {}, {}};
  auto file = source(folder.path("top.json"));
  for (const auto& [name, size, port] :
       {std::tuple{"force_gain", 0.5, "force_gain.u"}, {"actuator_lag", 0.01, "actuator_lag.command"}}) {
    Problems problems;
    const auto inserted = insert_effect(file, site, effect_named(name), {size}, axis_sizes(), problems);
    ASSERT_TRUE(inserted) << problems.text();
    ASSERT_EQ(inserted->input_at.size(), 1u);
    EXPECT_EQ(inserted->input_at[0].from, "amp.u");
    EXPECT_EQ(inserted->input_at[0].to, std::vector<std::string>{port});
    file = std::make_shared<SourceFile>(SourceFile{file->name, inserted->text});
  }
  EXPECT_TRUE(has(file->text, R"("in": {"command": "force_gain.y"})")) << file->text;
  EXPECT_TRUE(has(file->text, R"("in": {"u": "actuator_lag.force"})")) << file->text;
}

/// 1 N*m*s per revolution is 1/(2 pi) N*m*s/rad.
TEST(Insertion, AddsToASettingPerRevolution) {
  DiagramFolder folder;
  folder.with("top.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 2, "unit": "N*m"}},
    "viscous": {"type": "ViscousFriction", "damping": {"value": 1, "unit": "N*m*s/rev"}, "in": {"velocity": "mass.velocity"}},
    "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "viscous.force"]}},
    "mass": {"type": "Mass", "mass": {"value": 1, "unit": "kg*m^2"}, "in": {"force": "net.sum"}}},
    "log": ["mass.velocity"]})");
  const InsertionSite site{{{"position", "mass.position"}, {"force", "net.sum"}}, {}, {"rad", "N*m", "N*m"}};
  const auto file = source(folder.path("top.json"));
  const std::string text = insert_text(file, site, effect_named("viscous_friction"), {2});
  const double damping = 2 + 1 / (2 * std::numbers::pi);
  EXPECT_NEAR(signal(run_text(text, file->name), "mass.velocity").back(),
              2 / damping * (1 - std::exp(-damping)), 1e-6)
      << text;
}

}  // namespace loopwright::insert_test
