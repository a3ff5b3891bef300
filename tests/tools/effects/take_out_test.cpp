// Effects that one number takes out of a diagram again, and several errors of one sensor.
#include "tools/effects/take_out.h"
#include <gtest/gtest.h>
#include <cmath>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "tests/engine/written_diagram.h"
#include "tests/tools/effects/amplified_mass.h"
#include "tests/tools/effects/axis_sizes.h"
#include "tools/effects/insert.h"
#include "where.h"

namespace loopwright::take_out_test {

namespace {

std::shared_ptr<const SourceFile> source(const std::string& path) {
  Problems problems;
  return read_source(path, {}, problems);
}

RunResult run_text(const SourceFile& file, std::vector<std::pair<std::string, std::string>> set = {}) {
  Problems problems;
  const Value root = parse_json(std::make_shared<SourceFile>(file), problems);
  set.emplace_back("solver.record_step", "0.001");
  const auto diagram = read_diagram(root, file.name, {.set = set}, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  EXPECT_EQ(problems.text(), "") << file.text;
  return plan ? simulate(*plan) : RunResult{RunStatus::failed};
}

Insertion inserted(std::shared_ptr<const SourceFile> file, const InsertionSite& site, const Effect& effect,
                   const std::vector<double>& fitted) {
  Problems problems;
  const auto insertion = insert_effect(std::move(file), site, effect, fitted, axis_sizes(), problems);
  EXPECT_EQ(problems.text(), "") << effect.name;
  return insertion.value_or(Insertion{});
}

double largest_difference(const RunResult& a, const RunResult& b, const char* name) {
  const std::vector<double>&x = signal(a, name), &y = signal(b, name);
  double most = x.size() == y.size() ? 0 : 1e300;
  for (size_t i = 0; i < std::min(x.size(), y.size()); ++i) most = std::max(most, std::abs(x[i] - y[i]));
  return most;
}

}  // namespace

TEST(TakingOut, OneNumberTakesEveryEffectOutAgain) {
  const auto file = source(LOOPWRIGHT_SOURCE "/diagrams/axis/nominal.json");
  InsertionSite site{{{"position", "axis.position"},
                      {"velocity", "axis.velocity"},
                      {"force", "axis.net_force"},
                      {"input", "axis.force"}},
                     {},
                     {}};
  const RunResult nominal = run_text(*file);
  const std::vector<Effect> catalogue = whole_catalogue();
  ASSERT_GE(catalogue.size(), 23u);
  for (const Effect& effect : catalogue) {
    SCOPED_TRACE(effect.name + " " + effect.form);
    std::vector<double> fitted;
    for (const EffectParameter& p : effect.parameters)
      if (p.is_fitted) fitted.push_back(range_of(p, axis_sizes()).start);
    site.can_be_taken_out = false;
    const RunResult without_switch = run_text({file->name, inserted(file, site, effect, fitted).text});
    site.can_be_taken_out = true;
    const Insertion insertion = inserted(file, site, effect, fitted);
    ASSERT_EQ(insertion.taken_out_by, "axis.with_" + effect.name);
    const SourceFile improved{file->name, insertion.text};
    const RunResult with = run_text(improved);
    EXPECT_LE(largest_difference(without_switch, with, "axis.position"), 1e-9);
    const RunResult without = run_text(improved, {{insertion.taken_out_by, "0"}});
    EXPECT_LE(largest_difference(nominal, without, "axis.position"), 1e-12);
  }
}

/// Both errors of A sin(2 pi x/L): their sum, but for the product of one with the slope of the other.
TEST(TakingOut, TwoErrorsOfASensorAddUp) {
  DiagramFolder folder;
  folder.with("axis.json", R"({"loopwright": 1, "inputs": {"force": "N"},
    "outputs": {"position": "mass.position", "net_force": "net_force.sum"},
    "blocks": {"net_force": {"type": "Sum", "in": {"terms": ["force"]}},
               "mass": {"type": "Mass", "mass": 1, "in": {"force": "net_force.sum"}}}})");
  folder.with("top.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "axis": {"diagram": "axis.json", "in": {"force": "push.y"}}},
    "log": ["axis.position", "axis.mass.position"]})");
  folder.with("flat.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 1}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "net": {"type": "Sum", "in": {"terms": ["push.y"]}},
    "mass": {"type": "Mass", "mass": 1, "in": {"force": "net.sum"}},
    "seen": {"type": "Gain", "gain": 1, "in": {"u": "mass.position"}}},
    "log": ["seen.y", "mass.position"]})");
  constexpr double pitches[] = {0.1, 0.03}, sizes[] = {1e-4, 5e-5};
  struct Case {
    const char *file, *measured, *truth;
    RolePorts roles;
  };
  for (const Case& c :
       {Case{"top.json",
             "axis.position",
             "axis.mass.position",
             {{"position", "axis.position"}, {"force", "axis.net_force"}}},
        Case{"flat.json", "seen.y", "mass.position", {{"position", "mass.position"}, {"force", "net.sum"}}}})
    for (const bool can_be_taken_out : {false, true}) {
      InsertionSite site{c.roles, {}, {}, can_be_taken_out};
      auto file = source(folder.path(c.file));
      for (int i : {0, 1}) {
        const Insertion insertion =
            inserted(file, site, effect_named("encoder_periodic_error"), {pitches[i], sizes[i], 0});
        for (const MovedPort& moved : insertion.measured_at)
          for (auto& [role, port] : site.roles)
            if (port == moved.from) port = moved.to.front();
        file = std::make_shared<SourceFile>(SourceFile{file->name, insertion.text});
      }
      const RunResult result = run_text(*file);
      const std::vector<double>&seen = signal(result, c.measured), &truth = signal(result, c.truth);
      for (size_t k = 0; k < seen.size(); ++k) {
        double expected = truth[k];
        for (int i : {0, 1}) expected += sizes[i] * std::sin(2 * M_PI * truth[k] / pitches[i]);
        ASSERT_NEAR(seen[k], expected, sizes[0] * sizes[1] * 2 * M_PI / pitches[1] * 1.1)
            << c.file << " at " << k << "\n"
            << file->text;
      }
    }
}

/// A mass in kg with one effect's share is an expression of bare numbers, to which the next one adds its own.
TEST(TakingOut, TwoEffectsShareTheMass) {
  DiagramFolder folder;
  folder.with("axis.json", R"({"loopwright": 1, "inputs": {"force": "N"},
    "outputs": {"position": "mass.position", "velocity": "mass.velocity", "net_force": "net_force.sum"},
    "blocks": {"net_force": {"type": "Sum", "in": {"terms": ["force"]}},
               "mass": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "net_force.sum"}}}})");
  folder.with("top.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0001, "stop": 0.2}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "axis": {"diagram": "axis.json", "in": {"force": "push.y"}}}, "log": ["axis.position"]})");
  folder.with("flat.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.0001, "stop": 0.2}, "blocks": {
    "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "net": {"type": "Sum", "in": {"terms": ["push.y"]}},
    "mass": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "net.sum"}}},
    "log": ["mass.position"]})");
  const RolePorts nested{
      {"position", "axis.position"}, {"velocity", "axis.velocity"}, {"force", "axis.net_force"}};
  const RolePorts flat{{"position", "mass.position"}, {"velocity", "mass.velocity"}, {"force", "net.sum"}};
  for (const auto& [name, roles, position] :
       {std::tuple{"top.json", nested, "axis.position"}, std::tuple{"flat.json", flat, "mass.position"}}) {
    const auto nominal = source(folder.path(name));
    auto file = nominal;
    std::vector<std::pair<std::string, std::string>> out;
    for (const char* effect_name : {"backlash", "flexible_mode", "inertia"}) {
      const Effect effect = effect_named(effect_name);
      std::vector<double> fitted;
      for (const EffectParameter& p : effect.parameters)
        if (p.is_fitted) fitted.push_back(range_of(p, axis_sizes()).start);
      const Insertion insertion = inserted(file, {roles, {}, {}, true}, effect, fitted);
      out.emplace_back(insertion.taken_out_by, "0");
      file = std::make_shared<SourceFile>(SourceFile{file->name, insertion.text});
    }
    const RunResult bare = run_text(*nominal), all = run_text(*file), none = run_text(*file, out);
    EXPECT_LE(largest_difference(bare, none, position), 1e-12) << file->text;
    EXPECT_GE(largest_difference(bare, all, position), 1e-4) << file->text;
  }
}

/// Even if an effect reads the command in several blocks, an experiment drives one port.
TEST(TakingOut, AnEffectOfADrivenPortIsDrivenAtOnePort) {
  DiagramFolder folder;
  folder.with("top.json", amplified_mass);
  const InsertionSite site{{{"force", "net.sum"}, {"input", "amp.u"}}, {}, {}, true};
  for (const char* name : {"force_gain", "actuator_lag", "input_delay", "force_saturation"}) {
    const Effect effect = effect_named(name);
    std::vector<double> fitted;
    for (const EffectParameter& p : effect.parameters)
      if (p.is_fitted) fitted.push_back(range_of(p, axis_sizes()).start);
    const Insertion insertion = inserted(source(folder.path("top.json")), site, effect, fitted);
    ASSERT_EQ(insertion.input_at.size(), 1u) << name;
    EXPECT_EQ(insertion.input_at[0].from, "amp.u");
    EXPECT_EQ(insertion.input_at[0].to, std::vector<std::string>{std::string(name) + "_input.u"});
  }
}

}  // namespace loopwright::take_out_test
