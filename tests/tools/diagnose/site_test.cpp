// Where terms can act in a diagram, and how the predictor responds to them.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/predict/site_filter.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/diagnose/verdict/site_errors.h"

namespace loopwright::diagnosis::site_test {
namespace {

/// Without the sensors, which every compared output has.
std::vector<std::string> names(const std::vector<Site>& sites) {
  std::vector<std::string> list;
  for (const Site& site : sites)
    if (site.kind != Site::Kind::sensor) list.push_back(site.name);
  return list;
}

TEST(Sites, OfAMotorAreItsTwoSumsAndItsInput) {
  const RecordedPlant files(motor({}, 1));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  EXPECT_THAT(names(model.sites()),
              testing::UnorderedElementsAre("voltages.sum", "torques.sum", "amplifier.u"));
}
TEST(Sites, ASignalThatTwoSumsReadIsACoupling) {
  const RecordedPlant files(tanks({}, 1));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  EXPECT_THAT(names(model.sites()),
              testing::UnorderedElementsAre("balance1.sum", "balance2.sum", "outlet1.y", "pump.u"));
  const auto coupling = std::ranges::find(model.sites(), "outlet1.y", &Site::name);
  EXPECT_EQ(coupling->kind, Site::Kind::shared);
  EXPECT_EQ(coupling->quantity, Quantity::flow);
}
TEST(Sites, ADifferenceThatOnlyAGainReadsIsNoSiteOfItsOwn) {
  const RecordedPlant files(thermal({}, 1));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  EXPECT_THAT(names(model.sites()),
              testing::UnorderedElementsAre("heat1.sum", "heat2.sum", "flow.y", "heater.u"));
}

TEST(Sites, ABodyThatIsDrivenItselfHasOneForTermsBesideThatForDistortions) {
  const RecordedPlant files(heated_plate(nothing, 1));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  std::vector<Site::Kind> kinds;
  for (const Site& site : model.sites())
    if (site.name == "plate.heat") kinds.push_back(site.kind);
  EXPECT_THAT(kinds, testing::UnorderedElementsAre(Site::Kind::input, Site::Kind::wire));
}

TEST(Sites, BothOfOneNameAreLookedAtIfTheExperimentNamesIt) {
  Plant plant = heated_plate(nothing, 1);
  plant.more = R"("sites": ["plate.heat"])";
  const RecordedPlant files(plant);
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  for (const Site& site : model.sites()) EXPECT_EQ(site.is_searched, site.name == "plate.heat") << site.name;
}

TEST(Sites, SensorsAreLookedAtOnlyIfTheExperimentNamesThem) {
  const RecordedPlant files(motor({}, 1));
  const auto searched_sensors = [&](const std::string& experiment) {
    std::vector<std::string> list;
    const SiteModel model(files.diagram(), {experiment}, {});
    for (const Site& site : model.sites())
      if (site.kind == Site::Kind::sensor && site.is_searched) list.push_back(site.name);
    return list;
  };
  EXPECT_THAT(searched_sensors(files.experiment()), testing::IsEmpty());
  auto json = nlohmann::json::parse(std::ifstream(files.experiment()));
  const std::string sensor = json["compare"].begin().key() + " (sensor)";
  json["sites"] = {sensor};
  const std::string naming =
      std::filesystem::path(files.experiment()).replace_filename("sensor.experiment.json").string();
  std::ofstream(naming) << json.dump();
  EXPECT_THAT(searched_sensors(naming), testing::ElementsAre(sensor));
}

struct Passed {
  RecordedPlant files;
  SiteModel model;
  SiteFilter filter;
  SiteNoise noise;
  SitePass pass;
  std::vector<double> factors;

  explicit Passed(const Plant& plant)
      : files(plant),
        model(files.diagram(), {files.experiment()}, {}),
        filter(model),
        factors(model.parameters().size(), 1.0) {
    model.use(factors, {});
    for (int round = 0; round < 3; ++round) {
      noise = filter.guess_noise();
      EXPECT_TRUE(filter.run(model.record().rows(), noise, true, pass));
      filter.learn_scales(pass);
      filter.choose_substeps(pass);
    }
  }
  int site(const std::string& name) const {
    return int(std::ranges::find(model.sites(), name, &Site::name) - model.sites().begin());
  }
  int variable(const std::string& name) const {
    return int(std::ranges::find(model.variables(), name, &SiteVariable::name) - model.variables().begin());
  }
};

/// The first guess, from which the fit of the noise begins.
TEST(Sites, NoiseOfASensorThatIsReadInSomeRowsIsGuessed) {
  Plant plant = thermal({}, 2);
  plant.reads_every = {1, 7};
  const RecordedPlant files(plant);
  SiteModel model(files.diagram(), {files.experiment()}, {});
  const SiteNoise noise = SiteFilter(model).guess_noise();
  ASSERT_EQ(noise.measurement.size(), 2u);
  for (const double guess : noise.measurement) {
    EXPECT_GT(guess, 0.3 * plant.measurement_noise[0]);
    EXPECT_LT(guess, 10 * plant.measurement_noise[0]);
  }
}

/// The errors of the model with a small term, against the linear response to the term along the path.
void expect_response(Passed& p, const std::string& site, const std::string& variable,
                     const std::string& shape_name) {
  SiteTerm term;
  term.shape = &*std::ranges::find(named_shapes(), shape_name, &TermShape::name);
  term.site = p.site(site), term.variable = p.variable(variable);
  const SiteVariable& v = p.model.variables().at(size_t(term.variable));
  std::array<std::vector<double>, 3> phi;
  double largest = 0;
  for (size_t part = 0; part < 3; ++part)
    for (size_t k = 0; k < p.pass.rows; ++k) {
      double column[most_columns];
      term.columns(v.at(&p.pass.path[part][k * p.pass.numbers]), column);
      phi[part].push_back(column[0]), largest = std::max(largest, std::abs(column[0]));
    }
  std::vector<double> expected(p.pass.error.size()), errors(p.pass.error.size());
  p.filter.respond(p.pass, term.site, phi[0], phi[1], phi[2], expected);
  term.coefficient[0] = 1e-3 * p.filter.site_scale(term.site) / largest;
  p.model.use(p.factors, std::span(&term, 1));
  ASSERT_TRUE(p.filter.run_frozen(p.pass, errors));
  double off = 0, size = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    const double response = (p.pass.error[i] - errors[i]) / std::sqrt(p.pass.variance[i]);
    const double by_recursion = term.coefficient[0] * expected[i];
    off += std::pow(response - by_recursion, 2), size += by_recursion * by_recursion;
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(off, 1e-4 * size) << site << " " << variable;
}

TEST(SiteFilter, ATermChangesTheErrorsAsTheRecursionSays) {
  Passed of_motor(motor({}, 2));
  expect_response(of_motor, "torques.sum", "rotor.velocity", "linear");
  expect_response(of_motor, "voltages.sum", "current.y", "signed_square");
  Passed of_tanks(tanks({}, 2));
  expect_response(of_tanks, "outlet1.y", "level1.y", "square");
  Passed of_train(drive_train({}, 2));
  expect_response(of_train, "on_load.sum", "load.velocity", "linear");
}
TEST(SiteFilter, FrozenGainsGiveTheErrorsOfTheWholePass) {
  Passed p(oscillator({}, 3));
  std::vector<double> errors(p.pass.error.size());
  ASSERT_TRUE(p.filter.run_frozen(p.pass, errors));
  for (size_t k = 0; k < errors.size(); ++k) ASSERT_NEAR(errors[k], p.pass.error[k], 1e-12);
}
/// A flow that is only tried must not switch the relay for the rows behind it.
TEST(SiteFilter, ARelayIsAsItWasAfterFlowsThatWereOnlyTried) {
  Plant plant = oscillator({}, 6);
  const std::string before = R"("net":     {"type": "Sum", "signs": "+--", "in": {"terms": ["shaker.y",)";
  ASSERT_NE(plant.diagram.find(before), std::string::npos);
  plant.diagram.replace(plant.diagram.find(before), before.size(), R"(
    "hand": {"type": "Relay", "switch_on": {"value": 0.02, "unit": "m"}, "switch_off": {"value": -0.02, "unit": "m"},
             "on": {"value": 4, "unit": "N"}, "in": {"u": "mass.position"}},
    "net": {"type": "Sum", "signs": "+---", "in": {"terms": ["shaker.y", "hand.y",)");
  Passed p(plant);
  std::vector<double> errors(p.pass.error.size());
  ASSERT_TRUE(p.filter.run_frozen(p.pass, errors));
  for (size_t k = 0; k < errors.size(); ++k) ASSERT_NEAR(errors[k], p.pass.error[k], 1e-12) << k;
  constexpr size_t length = 50;
  const std::vector<bool> settles(p.pass.rows);
  for (size_t from = 100; from + length < p.pass.rows; from += 100) {
    std::vector<double> once(length), again(length), whole(p.pass.rows);
    ASSERT_TRUE(p.filter.simulate(p.pass, settles, from, from + length, once));
    ASSERT_TRUE(p.filter.simulate(p.pass, settles, 0, p.pass.rows - from, whole));
    ASSERT_TRUE(p.filter.simulate(p.pass, settles, from, from + length, again));
    ASSERT_EQ(once, again) << from;
  }
}
TEST(SiteFilter, TheObjectiveOfAnotherNoiseIsThatOfAPassWithIt) {
  Passed p(oscillator({}, 4));
  EXPECT_NEAR(p.filter.objective_with(p.pass, p.noise), p.pass.objective(),
              1e-6 * std::abs(p.pass.objective()));
  SiteNoise other = p.noise;
  other.process[0] *= 0.5, other.measurement[0] *= 2;
  const double expected = p.filter.objective_with(p.pass, other);
  ASSERT_TRUE(p.filter.run(p.model.record().rows(), other, false, p.pass));
  EXPECT_NEAR(expected, p.pass.objective(), 1e-3 * std::abs(p.pass.objective()));
}
TEST(SiteFilter, ErrorsOfARightDiagramAreWhiteAtTheTrueNoise) {
  Passed p(oscillator({}, 5));
  p.noise.process = {0.05}, p.noise.measurement = {2e-5};
  ASSERT_TRUE(p.filter.run(p.model.record().rows(), p.noise, false, p.pass));
  double square = 0, next = 0;
  std::vector<double> e;
  for (size_t k = 100; k < p.pass.rows; ++k) e.push_back(p.pass.error[k] / std::sqrt(p.pass.variance[k]));
  for (size_t k = 1; k < e.size(); ++k) square += e[k] * e[k], next += e[k] * e[k - 1];
  EXPECT_NEAR(square / double(e.size()), 1, 0.08);
  EXPECT_NEAR(next / square, 0, 0.06);
}

/// Mean squares of simulations that begin anew every 125 rows, and what is expected of them. Not in units of
/// the sensor's noise, which is a small part of them.
struct MeanSquares {
  double simulated = 0, expected = 0;
};
MeanSquares simulated_with_noise(double torque_noise) {
  constexpr size_t from = 125, length = 125;
  constexpr uint64_t records = 8;
  MeanSquares mean;
  for (uint64_t seed = 1; seed <= records; ++seed) {
    Plant plant = oscillator({}, seed);
    plant.process_noise = {torque_noise};
    Passed p(plant);
    p.noise.process = {torque_noise}, p.noise.measurement = {2e-5};
    EXPECT_TRUE(p.filter.run(p.pass.rows, p.noise, false, p.pass));
    std::vector<double> variance((p.pass.rows - from) * p.pass.outputs), error(length);
    const std::vector<bool> settles(p.pass.rows);
    p.filter.expect_of_simulations(p.pass, settles, from, length, variance);
    for (size_t begin = from; begin + length <= p.pass.rows; begin += length) {
      EXPECT_TRUE(p.filter.simulate(p.pass, settles, begin, begin + length, error));
      for (size_t k = 0; k < length; ++k)
        mean.simulated += error[k] * error[k], mean.expected += variance[begin - from + k];
    }
  }
  return mean;
}
TEST(SiteFilter, SimulationsMissAsMuchAsTheNoiseOfTheStatesMakesLikely) {
  const MeanSquares noisy = simulated_with_noise(0.05), little = simulated_with_noise(1e-4);
  EXPECT_NEAR(noisy.simulated / noisy.expected, 1, 0.2);
  EXPECT_NEAR(little.simulated / little.expected, 1, 0.05);
  EXPECT_GT(noisy.expected, 10 * little.expected);
}
/// Where a record begins, nobody knows its speed yet: what the filter then expects says nothing of the noise.
TEST(SiteFilter, SimulationsOfSeveralRecordsBeginWhereTheFilterHasSettled) {
  const RecordedPlant first(oscillator({}, 1)), second(oscillator({}, 2));
  SiteModel model(first.diagram(), {first.experiment(), second.experiment()}, {});
  SiteFilter filter(model);
  SiteFitter fitter(filter, model.record().held_out_from, [] { return false; });
  SiteHypothesis nominal;
  ASSERT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, nominal));
  SiteFitter whole(filter, model.record().rows(), [] { return false; });
  const SiteErrors errors = errors_of(whole, nominal);
  EXPECT_LT(errors.simulated[0], 2 * errors.expected_simulated[0]);
  EXPECT_GT(errors.simulated[0], 0.5 * errors.expected_simulated[0]);
}
TEST(SiteModel, ANumberOfABlockHasTheUnitOfItsType) {
  const RecordedPlant files(heated_plate(nothing, 1));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  const auto capacity = std::ranges::find(model.parameters(), "plate.capacity", &ModelParameter::name);
  ASSERT_NE(capacity, model.parameters().end());
  EXPECT_EQ(capacity->unit, "J/K");
}
TEST(SiteModel, ASettingOfTheDiagramChangesAllBlocksThatReadIt) {
  const RecordedPlant files(motor({}, 6));
  const SiteModel model(files.diagram(), {files.experiment()}, {});
  const auto inductance = std::ranges::find(model.parameters(), "inductance", &ModelParameter::name);
  ASSERT_NE(inductance, model.parameters().end());
  ASSERT_EQ(inductance->numbers.size(), 1u);
  EXPECT_NEAR(inductance->numbers[0].nominal, 500, 1e-9);
  EXPECT_NEAR(inductance->numbers[0].power, -1, 1e-9) << "the block holds its inverse";
}

}  // namespace
}  // namespace loopwright::diagnosis::site_test
