// What is said of an answer at the sites of a diagram, however it was found.
#include "tools/diagnose/verdict/site_verdict.h"
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tests/tools/diagnose/site_term.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/diagnose/verdict/site_errors.h"

namespace loopwright::site_verdict_test {
namespace {

using namespace diagnosis;
using testing::Contains, testing::HasSubstr, testing::Not;

Plant shaken(double force_noise) {
  Plant plant = oscillator({}, 62);
  plant.process_noise = {force_noise};
  return plant;
}

/// An oscillator as the diagram has it, and an answer about it that a search might give.
class Answered {
 public:
  explicit Answered(const Plant& plant) : files_(plant) {
    EXPECT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, search.nominal));
    search.found = search.nominal;
  }
  void move(std::string_view parameter) {
    const auto& all = model.parameters();
    const auto place = std::ranges::find(all, parameter, &ModelParameter::name);
    ASSERT_NE(place, all.end());
    search.found.is_free[size_t(place - all.begin())] = true;
  }
  void add(std::string_view shape, std::string_view variable, double coefficient) {
    search.found.terms.push_back(term_at_net_sum(model, shape, variable, coefficient));
  }
  Diagnosis answer() {
    Diagnosis result;
    tell_sites(filter, search, result);
    return result;
  }

 private:
  RecordedPlant files_;

 public:
  SiteModel model{files_.diagram(), {files_.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().held_out_from, [] { return false; }};
  SiteSearchResult search;
};

/// An oscillator with a constant, a hardening spring and a drag, all of which an answer names, beside the
/// parameters.
Diagnosis with_changes(double drag) {
  Oscillator m;
  m.force = [drag](double x, double v) { return 0.3 + 6000 * x * x * x + drag * v * std::abs(v); };
  Plant plant = oscillator(m, 62);
  plant.process_noise = {0};
  Answered a(plant);
  for (const char* parameter : {"mass", "damping", "stiffness"}) a.move(parameter);
  a.add("constant", "", -0.3), a.add("cube", "mass.position", -6000);
  if (drag > 0) a.add("signed_square", "mass.velocity", -drag);
  a.fitter.fit_noise(a.search.found);
  return a.answer();
}
TEST(SiteVerdict, SixChangesAtOnceNameNothing) {
  const Diagnosis six = with_changes(0.5), five = with_changes(0);
  EXPECT_THAT(findings(six), Contains(HasSubstr("6 changes at once; they may stand for one effect")));
  EXPECT_EQ(six.verdict, Verdict::partly_explained) << to_text(six);
  EXPECT_THAT(findings(five), Not(Contains(HasSubstr("changes at once"))));
  EXPECT_EQ(five.verdict, Verdict::explained) << to_text(five);
}

TEST(SiteVerdict, TheErrorsToldAreThoseOfTheOutputThatTheDiagramMissesWorst) {
  Tanks m;
  m.second_outlet = 0.0055;  // the first tank is as stated
  Answered a(tanks(m, 63));
  a.move("second_outlet");
  const Diagnosis d = a.answer();
  EXPECT_EQ(d.measured_port, "level2.y");
  EXPECT_EQ(d.measured_unit, "m");
  EXPECT_NEAR(d.steps.front().force_rmse, d.error_before, 0.2 * d.error_before);
  EXPECT_GT(d.steps.front().simulation_rmse, 0.01) << "of the second level, not of the first";
}
TEST(SiteVerdict, AWidthIsNotNegativeAnywhereInItsInterval) {
  Oscillator m;
  m.force = [](double, double v) { return std::tanh(v / 1e-3); };
  Answered a(oscillator(m, 64));
  a.add("sign", "mass.velocity", -1);
  SiteTerm& term = a.search.found.terms.front();
  term.nonlinear[0] = 1e-3, term.low[0] = 1e-9, term.high[0] = 0.1;
  a.fitter.fit_noise(a.search.found);
  const Diagnosis d = a.answer();
  const auto width = std::ranges::find(d.effects.front().parameters, "width", &DiagnosedParameter::name);
  ASSERT_NE(width, d.effects.front().parameters.end());
  EXPECT_GE(width->low, 0) << to_text(d);
}
TEST(SiteVerdict, ProportionsToTwoSignalsMayBeTheirProduct) {
  Answered a(shaken(0.05));
  a.add("linear", "mass.position", 1);
  EXPECT_THAT(a.answer().not_observable, Not(Contains(HasSubstr("product"))));
  a.add("linear", "mass.velocity", 0.1);
  EXPECT_THAT(a.answer().not_observable,
              Contains(HasSubstr("linear(mass.position) and net.sum: linear(mass.velocity) may be one law")));
}
TEST(SiteVerdict, SitesThatLookAlikeAreToldInOneSentence) {
  EXPECT_THAT(Answered(shaken(0.05)).answer().not_observable,
              Contains(HasSubstr("what acts at net.sum and what acts at shaker.u look alike")));
}

/// The force has so much noise that a simulation misses by more than that of the sensor.
TEST(SiteVerdict, NoiseInsideThePlantIsToldByItsSize) {
  Answered a(shaken(0.5));
  a.move("stiffness");
  a.search.found.noise.process = {0.5}, a.search.found.noise.measurement = {2e-5};
  EXPECT_THAT(findings(a.answer()), Contains(HasSubstr("it is taken for that noise")));
  a.search.found.noise.process = {0.05};  // which would make a tenth of it likely
  const Diagnosis d = a.answer();
  EXPECT_THAT(findings(d), Contains(HasSubstr("an effect that nothing here names may bend what was found")));
  EXPECT_NE(d.verdict, Verdict::explained) << to_text(d);
}
TEST(SiteVerdict, SimulationsAsGoodAsTheSensorNeedNoWord) {
  Answered a(shaken(0));
  a.move("stiffness");
  a.search.found.noise.process = {1e-4}, a.search.found.noise.measurement = {2e-5};
  EXPECT_THAT(findings(a.answer()), Not(Contains(HasSubstr("of which noise inside the plant makes"))));
}

TEST(SiteErrors, AnAnswerBySimulationExpectsTheErrorsOfItsSensorsAndTheirSlowNoise) {
  Answered a(shaken(0));
  SiteFitter whole(a.filter, a.model.record().rows(), [] { return false; });
  SiteHypothesis h = a.search.nominal;
  h.noise = a.filter.noise_of_simulation(), h.noise.measurement = {2e-5}, h.noise.slow.clear();
  SiteErrors errors = errors_of(whole, h);
  EXPECT_NEAR(errors.expected_simulated[0], 2e-5, 1e-9);
  EXPECT_NEAR(errors.simulated[0], 2e-5, 2e-6) << "nothing but the noise of the sensor is there";
  h.noise.slow = {{.output = 0, .size = 4e-5, .time = 0.5}};
  errors = errors_of(whole, h);
  EXPECT_NEAR(errors.expected_simulated[0], std::hypot(2e-5, 4e-5), 1e-9);
  EXPECT_TRUE(errors.leaves_slow_error) << "slow noise above that of the sensor";
}

}  // namespace
}  // namespace loopwright::site_verdict_test
