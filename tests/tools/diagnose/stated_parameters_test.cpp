// What the record does not determine stays as the diagram states it.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::stated_parameters_test {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// Mass, damping, stiffness and the gain of the force: only their ratios matter.
class CommonScale : public testing::Test {
 protected:
  CommonScale() {
    at.factors.assign(model.parameters().size(), 1.0), at.is_free.assign(at.factors.size(), true);
    at.noise = filter.guess_noise();
    diagnosis::SitePass pass;
    EXPECT_TRUE(fitter.pass(at, true, pass));
    filter.learn_scales(pass);
  }
  double objective_at(double scale) {
    diagnosis::SiteHypothesis scaled = at;
    std::ranges::fill(scaled.factors, scale);
    diagnosis::SitePass pass;
    EXPECT_TRUE(fitter.pass(scaled, false, pass));
    return scaled.scaled_objective;
  }

  RecordedPlant files{oscillator({}, 9)};
  diagnosis::SiteModel model{files.diagram(), {files.experiment()}, {}};
  diagnosis::SiteFilter filter{model};
  diagnosis::SiteFitter fitter{filter, model.record().held_out_from, [] { return false; }};
  diagnosis::SiteHypothesis at;
};

TEST_F(CommonScale, HasAsLittleNoiseInASimulationWhateverItIs) {
  ASSERT_EQ(model.parameters().size(), 4u);
  at.noise = filter.noise_of_simulation();
  EXPECT_NEAR(objective_at(0.02), objective_at(1), 0.5);
}
TEST_F(CommonScale, ReturnsToWhatIsStated) {
  at.noise = filter.guess_noise();
  fitter.fit_noise(at);
  std::ranges::fill(at.factors, 0.3);
  fitter.refine(at, 20);
  for (size_t i = 0; i < at.factors.size(); ++i)
    EXPECT_NEAR(at.factors[i], 1, 0.05) << model.parameters()[i].name;
}

/// Two coupled tanks of which one is measured: a leak bends the parameters that were fitted before it was
/// tried, and beside these another law is found first.
TEST(StatedParameters, OneLawInThePlaceOfParametersIsTheAnswerIfItExplainsMore) {
  IS_A_JUDGEMENT();
  Plant plant;
  plant.diagram = R"json({"loopwright": 1, "title": "Two coupled tanks",
  "parameters": {"A": {"value": 0.015, "unit": "m^2"}, "kp": {"value": 4e-5, "unit": "m^3/(V*s)"},
                 "k12": {"value": 1.2e-4, "unit": "m^2.5/s"}, "ko": {"value": 1e-4, "unit": "m^2.5/s"}},
  "solver": {"method": "rk4", "step": 0.2, "stop": 1},
  "blocks": {
    "off":   {"type": "Constant", "value": {"value": 0, "unit": "V"}},
    "pump":  {"type": "Gain", "gain": "=kp", "in": {"u": "off.y"}},
    "b1":    {"type": "Sum", "signs": "+-", "in": {"terms": ["pump.y", "q12.y"]}},
    "r1":    {"type": "Gain", "gain": "=1/A", "in": {"u": "b1.sum"}},
    "h1":    {"type": "Integrator", "initial": {"value": 0.15, "unit": "m"}, "in": {"u": "r1.y"}},
    "dh":    {"type": "Sum", "signs": "+-", "in": {"terms": ["h1.y", "h2.y"]}},
    "root":  {"type": "Expression", "formula": "sign(h)*sqrt(abs(h))", "names": ["h"], "in": {"arguments": ["dh.sum"]}},
    "q12":   {"type": "Gain", "gain": "=k12", "in": {"u": "root.y"}},
    "b2":    {"type": "Sum", "signs": "+-", "in": {"terms": ["q12.y", "qo.y"]}},
    "r2":    {"type": "Gain", "gain": "=1/A", "in": {"u": "b2.sum"}},
    "h2":    {"type": "Integrator", "initial": {"value": 0.1, "unit": "m"}, "in": {"u": "r2.y"}},
    "root2": {"type": "Expression", "formula": "sign(h)*sqrt(abs(h))", "names": ["h"], "in": {"arguments": ["h2.y"]}},
    "qo":    {"type": "Gain", "gain": "=ko", "in": {"u": "root2.y"}}
  }})json";
  plant.drive = R"("pump.u": {"column": "u", "unit": "V"})";
  plant.compare = R"("h1.y": {"column": "y0", "unit": "m"})";
  const auto root = [](double h) { return std::copysign(std::sqrt(std::abs(h)), h); };
  plant.rate = [root](const Numbers& x, double u, const Numbers& w) {
    const double q12 = 1.2e-4 * root(x[0] - x[1]);
    return Numbers{(4e-5 * u + w[0] - q12 - 4e-5 * root(x[0])) / 0.015, (q12 - 1e-4 * root(x[1])) / 0.015};
  };
  plant.outputs = [](const Numbers& x) { return Numbers{x[0]}; };
  plant.input = [steps = random_steps(80, 27)](double t) { return 1.6 + 1.2 * steps(t); };
  plant.initial = {0.15, 0.1}, plant.process_noise = {1e-8}, plant.measurement_noise = {5e-4};
  plant.sample_time = 1, plant.rows = 1800, plant.seed = 27;
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(terms(d), ElementsAre("b1.sum: square_root(h1.y)")) << to_text(d);
  EXPECT_THAT(d.moved_parameters, IsEmpty());
}

}  // namespace
}  // namespace loopwright::stated_parameters_test
