// One law under several names: which of them is the answer, and which is declared.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/search/same_response.h"
#include "tools/diagnose/search/simpler_answers.h"
#include "tools/diagnose/search/stacked_names.h"
#include "tools/diagnose/wording.h"

namespace loopwright::same_law_test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not;
using namespace diagnosis;

const TermShape& shape(std::string_view name) {
  return *std::ranges::find(named_shapes(), name, &TermShape::name);
}
std::vector<std::string> others(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const OtherExplanation& other : d.other_explanations)
    list.push_back(
        fmt::format("{} for {}", fmt::join(other.effects, " + "), fmt::join(other.in_place_of, " + ")));
  return list;
}
void put(Plant& plant, const std::string& before, const std::string& after) {
  const size_t at = plant.diagram.find(before);
  ASSERT_NE(at, std::string::npos);
  plant.diagram.replace(at, before.size(), after);
}
/// The spring is stated by a product of two parameters.
Plant shared_stiffness(double true_one) {
  Plant plant = oscillator({.stiffness = true_one}, 71);
  put(plant, R"("parameters": {)", R"("parameters": {"share": 1, )");
  put(plant, R"("stiffness": "=stiffness")", R"("stiffness": "=stiffness*share")");
  return plant;
}

/// A mass that is pushed and braked, and its spring stiffens, in a diagram that knows nothing of that.
Plant pushed_mass(double cubic) {
  return oscillator(
      {.force = [=](double x, double v) { return 0.6 * v * std::abs(v) + cubic * x * x * x - 0.8; }}, 77);
}

/// Gives the steps of a search to a test.
struct Joining : SimplerAnswers {
  Joining(SiteFitter& fitter, double readings) : SimplerAnswers(fitter) { readings_ = readings; }
  using SimplerAnswers::join_terms;
  const std::vector<ParameterRival>& declared() const { return result_.parameter_rivals; }
};

class FittedOscillator : public testing::Test {
 protected:
  explicit FittedOscillator(const Plant& plant = shared_stiffness(220)) : files(plant) {
    at.factors.assign(model.parameters().size(), 1.0), at.is_free.assign(at.factors.size(), false);
    at.noise = filter.guess_noise();
    SitePass pass;
    EXPECT_TRUE(fitter.pass(at, true, pass));
    filter.learn_scales(pass);
    at.noise = filter.guess_noise();
    fitter.fit_noise(at);
  }
  int parameter(const std::string& name) const {
    return int(std::ranges::find(model.parameters(), name, &ModelParameter::name) -
               model.parameters().begin());
  }
  SiteTerm term(std::string_view name, const std::string& of, double coefficient) const {
    SiteTerm t;
    t.shape = &shape(name), t.coefficient[0] = coefficient, t.unit[0] = std::abs(coefficient);
    t.variable =
        int(std::ranges::find(model.variables(), of, &SiteVariable::name) - model.variables().begin());
    t.site = int(std::ranges::find(model.sites(), "net.sum", &Site::name) - model.sites().begin());
    return t;
  }
  std::vector<bool> all() const { return std::vector<bool>(model.parameters().size(), true); }

  RecordedPlant files;
  SiteModel model{files.diagram(), {files.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().held_out_from, [] { return false; }};
  SiteHypothesis at;
};

TEST_F(FittedOscillator, AProportionOfThePositionIsTheStiffnessOfItsSpring) {
  at.terms = {term("linear", "mass.position", -20)};
  const std::vector<SameResponse> list = parameters_of_same_response(fitter, at, all());
  const auto found =
      std::ranges::find(list, parameter("stiffness"), [](const SameResponse& s) { return s.parameter; });
  ASSERT_NE(found, list.end());
  EXPECT_EQ(found->of, 0u);
  EXPECT_THAT(found->hypothesis.terms, IsEmpty());
  EXPECT_NEAR(found->hypothesis.factors[size_t(found->parameter)], 1.1, 0.01);
}
TEST_F(FittedOscillator, OneOfTwoParametersThatAreMultipliedDoesWhatTheOtherDoes) {
  at.is_free[size_t(parameter("stiffness"))] = true;
  at.factors[size_t(parameter("stiffness"))] = 1.1;
  const std::vector<SameResponse> list = parameters_of_same_response(fitter, at, all());
  const auto found =
      std::ranges::find(list, parameter("share"), [](const SameResponse& s) { return s.parameter; });
  ASSERT_NE(found, list.end());
  EXPECT_EQ(found->of, std::nullopt);
  EXPECT_NEAR(found->hypothesis.factors[size_t(found->parameter)], 1.1, 0.01);
  EXPECT_EQ(found->hypothesis.free_parameters(), 1u);
}
class PushedMass : public FittedOscillator {
 protected:
  explicit PushedMass(double cubic = 0) : FittedOscillator(pushed_mass(cubic)) {}
  SiteTerm constant(double value) const {
    SiteTerm t = term("constant", "", value);
    t.variable = -1;
    return t;
  }
  void fit(std::vector<SiteTerm> terms) {
    at.terms = std::move(terms);
    fitter.anneal(at), fitter.refine(at, 4);
  }
  Joining joining{fitter, double(model.record().rows())};
};
class StiffeningMass : public PushedMass {
 protected:
  StiffeningMass() : PushedMass(3000) {}
};

TEST_F(PushedMass, OneTermTakesThePlaceOfTwoThatAreOne) {
  fit({constant(0.3), constant(0.4), term("signed_square", "mass.velocity", -0.5)});
  joining.join_terms(at, [](SiteHypothesis&) {});
  ASSERT_EQ(at.terms.size(), 2u);
  EXPECT_EQ(at.terms[0].shape->name, "signed_square");
  EXPECT_EQ(at.terms[1].shape->name, "constant");
  EXPECT_NEAR(at.terms[1].coefficient[0], 0.8, 0.02);
  ASSERT_EQ(joining.declared().size(), 1u);
  EXPECT_EQ(joining.declared()[0].of, 1u);
}
TEST_F(StiffeningMass, KeepsThreeTermsThatAreAllNeeded) {
  fit({constant(0.7), term("cube", "mass.position", -2500), term("signed_square", "mass.velocity", -0.5)});
  joining.join_terms(at, [](SiteHypothesis&) {});
  EXPECT_EQ(at.terms.size(), 3u);
  EXPECT_TRUE(joining.declared().empty());
}

TEST_F(FittedOscillator, LawsThatOpposeEachOtherCancelAndOthersDoNot) {
  const auto cancels = [&](double first, double second) {
    at.terms = {term("linear", "mass.velocity", first), term("linear", "mass.velocity", second)};
    const std::vector<StackedNames> names = stacked_names(fitter, at, 2);
    return names.size() == 1 && cancel(fitter, at, names[0]);
  };
  EXPECT_TRUE(cancels(1, -0.8));
  EXPECT_FALSE(cancels(1, -0.5));
  EXPECT_FALSE(cancels(1, 1));
}

/// The flow out of a tank as a power of its level that no law here has: a level that nearly every row exceeds
/// would be a name for a constant and a proportion.
TEST(SameLaw, ALevelAtTheEdgeOfTheRecordIsNone) {
  Tanks m;
  m.lost = [](double level, double) { return 0.006 * (std::pow(level, 0.65) - std::sqrt(level)); };
  Plant plant = tanks(m, 72);
  plant.input = [steps = random_steps(60, 72)](double t) { return 4 + 1.2 * steps(t); };
  const Diagnosis d = diagnosed(plant);
  for (const std::string& name : terms(d)) EXPECT_THAT(name, Not(HasSubstr("flow("))) << to_text(d);
}
TEST(SameLaw, OneOfTwoParametersThatAreMultipliedIsDeclaredForTheOther) {
  const Diagnosis d = diagnosed(shared_stiffness(220));
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  const bool is_stiffness = d.moved_parameters[0].name == "stiffness";
  EXPECT_THAT(others(d), Contains(is_stiffness ? "share for stiffness" : "stiffness for share"))
      << to_text(d);
}
TEST(SameLaw, AParameterThatTheExperimentStatesDoesNotMove) {
  Plant plant = shared_stiffness(220);
  plant.more = R"("set": {"stiffness": 200})";
  const Diagnosis d = diagnosed(plant);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  EXPECT_EQ(d.moved_parameters[0].name, "share");
  EXPECT_THAT(others(d), Not(Contains(HasSubstr("stiffness for")))) << to_text(d);
}
/// A plate that loses heat in proportion: both are one number.
TEST(SameLaw, AnOffsetOfASensorIsDeclaredWhereAConstantWasFound) {
  Plant plant = heated_plate(nothing, 73);
  plant.outputs = [](const Numbers& x) { return Numbers{x[0] + 0.5}; };
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(others(d), Contains(HasSubstr("(sensor): constant for"))) << to_text(d);
}
/// Its level feeds the outlet, so that an offset looks like a constant and another law of the outlet.
TEST(SameLaw, OneSensorThatIsOffIsTheAnswerInThePlaceOfSeveralLaws) {
  Plant plant = tanks({}, 74);
  plant.outputs = [](const Numbers& x) { return Numbers{x[0], x[1] - 0.03}; };
  plant.input = [steps = random_steps(60, 74)](double t) { return 4 + 1.2 * steps(t); };
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_EQ(d.effects[0].site, "level2.y (sensor)");
  EXPECT_NEAR(d.effects[0].parameters[0].value, -0.03, 1e-3);
  EXPECT_TRUE(d.moved_parameters.empty()) << to_text(d);
}
TEST(SameLaw, OneSensorThatIsOffIsFoundBesideAMissingLaw) {
  Tanks m;
  m.lost = [](double level, double) { return 8e-4 * level; };
  Plant plant = tanks(m, 76);
  plant.outputs = [](const Numbers& x) { return Numbers{x[0], x[1] - 0.03}; };
  plant.rows = 900;
  plant.input = [steps = random_steps(60, 76)](double t) { return 4 + 1.2 * steps(t); };
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_THAT(terms(d), testing::UnorderedElementsAre("balance1.sum: linear(level1.y)",
                                                      "level2.y (sensor): constant()"))
      << to_text(d);
}
TEST(SameLaw, ASensorOfAnotherScaleIsTheAnswerInThePlaceOfSeveralLaws) {
  Plant plant = tanks({}, 75);
  plant.outputs = [](const Numbers& x) { return Numbers{x[0], 1.06 * x[1]}; };
  plant.input = [steps = random_steps(60, 75)](double t) { return 4 + 1.2 * steps(t); };
  const Diagnosis d = diagnosed(plant);
  const bool is_answer = d.effects.size() == 1 && d.effects[0].site == "level2.y (sensor)";
  const std::vector<std::string> declared = others(d);
  EXPECT_TRUE(is_answer ||
              std::ranges::any_of(declared,
                                  [](const std::string& o) {
                                    return o.starts_with("level2.y (sensor): linear(level2.y) for ");
                                  }))
      << to_text(d);
}

TEST(SameLaw, AnIntervalHasEnoughDigitsToBeOne) {
  const ShownInterval told = shown_interval(1.38, 1.379992, 1.380008, "N");
  EXPECT_EQ(told.range(), "1.37999 N … 1.38001 N");
  EXPECT_EQ(shown_interval(1.5, 1.4, 1.6, "N").range(), "1.4 N … 1.6 N");
  EXPECT_EQ(shown_interval(1.5, 1.5, 1.5, "N").range(), "1.5 N … 1.5 N");
}

}  // namespace
}  // namespace loopwright::same_law_test
