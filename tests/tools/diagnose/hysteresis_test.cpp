// Dry friction that builds up over a distance, found without roles: a law that remembers.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include "engine/plan/plan.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/compare/compare.h"
#include "tools/diagnose/search/remembered_path.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::hysteresis_test {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// P. R. Dahl's law, in the displacement: the friction follows it towards plus or minus its level.
struct Friction {
  double level, distance;
};
Plant with_friction(const Friction& f, uint64_t seed) {
  Plant plant = oscillator({}, seed);
  plant.rate = [f, free = plant.rate](const Numbers& x, double u, const Numbers& w) {
    Numbers slope = free({x[0], x[1]}, u - f.level * x[2], w);
    slope.push_back((x[1] - std::abs(x[1]) * x[2]) / f.distance);
    return slope;
  };
  plant.initial = {0, 0, 0};
  return plant;
}

void expect_found(const Diagnosis& d, const Friction& truth) {
  ASSERT_THAT(terms(d), ElementsAre("net.sum: hysteresis(mass.velocity)")) << to_text(d);
  EXPECT_THAT(d.moved_parameters, IsEmpty());
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  expect_parameter(d.effects[0], "level", -truth.level, truth.level, "N");
  expect_parameter(d.effects[0], "transition_distance", truth.distance, truth.distance, "m");
}

TEST(Hysteresis, OverAShortDistanceIsNoDryFrictionThatChangesAtOnce) {
  const Friction friction{3, 0.03};
  expect_found(diagnosed(with_friction(friction, 51)), friction);
}
/// It acts nearly as a spring, and loses a little: neither a stiffness nor a damping does that.
TEST(Hysteresis, OverALongDistanceIsNoStiffness) {
  const Friction friction{12, 0.6};
  expect_found(diagnosed(with_friction(friction, 52)), friction);
}
/// The motion turns within a step of the integration, where the force changes most.
TEST(Hysteresis, AtEightSamplesAPeriodIsNotOnePercentWrong) {
  const Friction friction{4, 0.01};
  Plant plant = with_friction(friction, 55);
  plant.sample_time = 0.04, plant.process_noise = {2e-3}, plant.measurement_noise = {1e-5};
  expect_found(diagnosed(plant), friction);
}
TEST(Hysteresis, TurnsWhereTheVelocityDoes) {
  const auto& law = std::ranges::find(diagnosis::named_shapes(), "hysteresis", &diagnosis::TermShape::name);
  const double distance[] = {0.01};
  for (const auto& [from, to] : {std::pair{0.3, -0.1}, {-0.02, 0.5}, {0.2, 0.4}, {-0.1, 0.0}, {0.0, 0.0}}) {
    constexpr int steps = 100000;
    constexpr double time = 0.1, h = time / steps;
    double z = 0.4;
    for (int i = 0; i < steps; ++i) {
      const double v = from + (i + 0.5) / steps * (to - from),
                   middle = z + h / 2 * (v - std::abs(v) * z) / 0.01;
      z += h * (v - std::abs(v) * middle) / 0.01;
    }
    EXPECT_NEAR(law->remembered(0.4, from, to, time, distance), z, 1e-6) << from << " to " << to;
  }
}
TEST(Hysteresis, DryFrictionWithoutADistanceIsNone) {
  Oscillator m;
  m.force = [](double, double velocity) { return 2 * std::tanh(velocity / 0.02); };
  const Diagnosis d = diagnosed(oscillator(m, 53));
  EXPECT_THAT(terms(d), ElementsAre("net.sum: sign(mass.velocity)")) << to_text(d);
}
TEST(Hysteresis, IsWrittenAsABlockThatResists) {
  const RecordedPlant files(with_friction({3, 0.03}, 51));
  DiagnoseOptions options;
  options.improved_diagram =
      std::filesystem::path(files.diagram()).replace_filename("improved.json").string();
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()}, options);
  const auto blocks = nlohmann::json::parse(std::ifstream(d.improved))["blocks"];
  EXPECT_EQ(blocks["hysteresis_at_net"]["type"], "DahlFriction");
  Problems problems;
  const auto diagram = load_diagram(d.improved, {}, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  ASSERT_TRUE(plan) << problems.text();
  EXPECT_EQ(plan->without_unit.count, 0u) << to_string(plan->without_unit);
  const auto missed = [&](const std::string& by) {
    return compare(by, files.experiment(), {}).signals.front().rmse;
  };
  EXPECT_LT(missed(d.improved), 0.2 * missed(files.diagram()));
}

class RememberedFriction : public testing::Test {
 protected:
  RememberedFriction() {
    at.factors.assign(model.parameters().size(), 1.0), at.is_free.assign(at.factors.size(), false);
    at.noise = filter.guess_noise();
    EXPECT_TRUE(fitter.pass(at, true, pass));
    filter.learn_scales(pass), filter.choose_substeps(pass);
    term.shape = &*std::ranges::find(diagnosis::named_shapes(), "hysteresis", &diagnosis::TermShape::name);
    term.site =
        int(std::ranges::find(model.sites(), "net.sum", &diagnosis::Site::name) - model.sites().begin());
    term.variable =
        int(std::ranges::find(model.variables(), "mass.velocity", &diagnosis::SiteVariable::name) -
            model.variables().begin());
    term.nonlinear = {0.03, 0}, term.coefficient[0] = -3;
  }

  RecordedPlant files{with_friction({3, 0.03}, 54)};
  diagnosis::SiteModel model{files.diagram(), {files.experiment()}, {}};
  diagnosis::SiteFilter filter{model};
  diagnosis::SiteFitter fitter{filter, model.record().rows(), [] { return false; }};
  diagnosis::SiteHypothesis at;
  diagnosis::SitePass pass;
  diagnosis::SiteTerm term;
};

/// What it remembers goes on with the filtered motion alone, not with flows that are tried for derivatives.
TEST_F(RememberedFriction, GoesOnWithTheFilteredMotionAlone) {
  at.terms = {term};
  ASSERT_TRUE(fitter.pass(at, true, pass));
  std::vector<double> errors(pass.error.size());
  ASSERT_TRUE(filter.run_frozen(pass, errors));
  for (size_t k = 0; k < errors.size(); ++k) ASSERT_NEAR(errors[k], pass.error[k], 1e-12);
}
/// By exact integration along the same velocities, which change evenly within each half of a sample.
TEST_F(RememberedFriction, IsRankedByWhatItRemembersAlongThePath) {
  at.terms = {term};
  ASSERT_TRUE(fitter.pass(at, true, pass));
  const auto along = remembered_along(model, pass, term);
  double largest = 0, off = 0, z = 0;
  for (size_t k = 0; k < pass.rows; ++k) {
    off = std::max(off, std::abs(along[0][k] - z)), largest = std::max(largest, std::abs(z));
    for (size_t part : {0, 1}) {
      const auto velocity = [&](size_t p) {
        return model.variables()[size_t(term.variable)].at(&pass.path[p][k * pass.numbers]);
      };
      constexpr int steps = 200;
      const double from = velocity(part), to = velocity(part + 1), h = model.record().step(k) / 2 / steps;
      for (int i = 0; i < steps; ++i) {
        const double v = from + (i + 0.5) / steps * (to - from);
        const double middle = z + h / 2 * (v - std::abs(v) * z) / 0.03;
        z += h * (v - std::abs(v) * middle) / 0.03;
      }
    }
  }
  EXPECT_GT(largest, 0.9);
  EXPECT_LT(off, 1e-3);
}

}  // namespace
}  // namespace loopwright::hysteresis_test
