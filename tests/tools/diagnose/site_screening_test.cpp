// What the search without roles leaves out before it is fitted, and which names it takes for one signal's.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/search/site_screening.h"
#include "tools/diagnose/search/stacked_names.h"
#include "tools/diagnose/search/state_behind.h"

namespace loopwright::diagnosis::site_screening_test {
namespace {

const TermShape& shape(std::string_view name) {
  return *std::ranges::find(named_shapes(), name, &TermShape::name);
}

SiteCandidate candidate(const TermShape& of, int site, double gain, double cost) {
  SiteCandidate c;
  c.term.shape = &of, c.term.site = site, c.term.variable = 0, c.gain = gain, c.cost = cost;
  return c;
}

std::vector<int> sites(const std::vector<SiteCandidate>& list) {
  std::vector<int> result;
  for (const SiteCandidate& c : list) result.push_back(c.term.site);
  return result;
}

SiteHypothesis hypothesis(double objective) {
  SiteHypothesis h;
  h.objective = h.scaled_objective = objective;
  return h;
}

TEST(SiteScreening, TheSameLawAtADearerSiteIsATwin) {
  const TermShape& cube = shape("cube");
  std::vector<SiteCandidate> list{candidate(cube, 0, 1838.91, 1), candidate(cube, 1, 1838.90, 10),
                                  candidate(cube, 2, 1838.90, 2), candidate(shape("square"), 3, 1838.90, 10),
                                  candidate(cube, 4, 1700, 10)};
  leave_out_twins(list);
  EXPECT_THAT(sites(list), testing::ElementsAre(0, 2, 3, 4));
}

TEST(SiteScreening, WhatGainsLessThanHalfDoesNotReplaceATerm) {
  std::vector<SiteCandidate> list{candidate(shape("cube"), 0, 1000, 0), candidate(shape("square"), 1, 600, 0),
                                  candidate(shape("sign"), 2, 400, 0)};
  const SiteTerm own = list[0].term;
  leave_out_hopeless(list, own);
  EXPECT_THAT(sites(list), testing::ElementsAre(1));
}

TEST(SiteScreening, WhatIsFarBehindTheBestIsNotFittedToTheEnd) {
  std::vector<SiteHypothesis> list{hypothesis(-400), hypothesis(-1000), hypothesis(-600)};
  keep_best(list, hypothesis(0), 0.5);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].objective, -1000);
  EXPECT_EQ(list[1].objective, -600);
}

struct FittedTanks {
  RecordedPlant files{tanks({}, 5)};
  SiteModel model{files.diagram(), {files.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().rows(), [] { return false; }};
  SiteHypothesis at;

  FittedTanks() {
    at.factors.assign(model.parameters().size(), 1.0), at.is_free.assign(model.parameters().size(), false);
    at.noise = filter.guess_noise();
  }
  int variable(const std::string& name) const {
    return int(std::ranges::find(model.variables(), name, &SiteVariable::name) - model.variables().begin());
  }
  SiteTerm term(std::string_view name, const std::string& of) const {
    SiteTerm term;
    term.shape = &shape(name), term.variable = variable(of);
    term.site = int(std::ranges::find(model.sites(), "balance1.sum", &Site::name) - model.sites().begin());
    return term;
  }
};

TEST(StateBehind, TheRootOfALevelIsAnotherScaleOfIt) {
  FittedTanks tanks;
  SitePass pass;
  ASSERT_TRUE(tanks.fitter.pass(tanks.at, true, pass));
  const std::vector<int> behind = states_behind(tanks.model, pass);
  EXPECT_EQ(behind[size_t(tanks.variable("head1.y"))], tanks.variable("level1.y"));
  EXPECT_EQ(behind[size_t(tanks.variable("level2.y"))], tanks.variable("level2.y"));
  EXPECT_EQ(behind[size_t(tanks.variable("balance1.sum"))], tanks.variable("balance1.sum"));
}

TEST(StackedNames, OfALevelAndOfItsRootStandForOneFunctionOfTheLevel) {
  FittedTanks tanks;
  tanks.at.terms = {tanks.term("square", "level1.y"), tanks.term("cube", "head1.y")};
  const std::vector<StackedNames> stacked = stacked_names(tanks.fitter, tanks.at, 2);
  ASSERT_EQ(stacked.size(), 1u);
  EXPECT_EQ(stacked[0].variable, tanks.variable("level1.y"));
  EXPECT_EQ(stacked[0].terms.size(), 2u);
  EXPECT_FALSE(are_usual_together(tanks.at, stacked[0]));
}

TEST(SiteFitter, AChangeIsJudgedBesideAPassAsByItself) {
  FittedTanks tanks;
  SitePass pass;
  ASSERT_TRUE(tanks.fitter.pass(tanks.at, false, pass));
  EXPECT_NEAR(tanks.fitter.scaled_objective_beside(tanks.at, pass), pass.scaled_objective(), 1e-6);
  SiteHypothesis moved = tanks.at;
  moved.factors[0] = 1.01;
  const double beside = tanks.fitter.scaled_objective_beside(moved, pass);
  SitePass there;
  ASSERT_TRUE(tanks.fitter.pass(moved, false, there));
  EXPECT_NEAR(beside - pass.scaled_objective(), there.scaled_objective() - pass.scaled_objective(),
              0.05 * std::abs(there.scaled_objective() - pass.scaled_objective()));
}

TEST(SiteScreening, TheBestDistortionIsFittedWithTheFirstOfTheList) {
  const std::vector<SiteCandidate> list{
      candidate(shape("cube"), 0, 900, 0), candidate(shape("square"), 1, 800, 0),
      candidate(shape("saturation"), 2, 300, 0), candidate(shape("dead_zone"), 3, 200, 0)};
  EXPECT_THAT(sites(worth_fitting(list, 1)), testing::ElementsAre(2, 0));
  EXPECT_THAT(sites(worth_fitting(list, 3)), testing::ElementsAre(2, 0, 1));
  EXPECT_THAT(sites(worth_fitting({list[0]}, 3)), testing::ElementsAre(0));
}

TEST(StackedNames, AFunctionTakesTheConstantsOfItsSiteAndPredictsTheSame) {
  FittedTanks tanks;
  SiteTerm constant = tanks.term("constant", "level1.y"), function = tanks.term("square", "level1.y"),
           other = constant;
  constant.variable = other.variable = -1, constant.coefficient[0] = 2e-5, other.coefficient[0] = 1e-5;
  other.site = (constant.site + 1) % int(tanks.model.sites().size());
  function.shape = &unknown_functions().front(), function.nonlinear = {0.1, 0.6};
  for (size_t c = 0; c < 9; ++c) function.coefficient[c] = 1e-5 * double(c % 3);
  tanks.at.terms = {constant, other, function};
  SitePass before, after;
  ASSERT_TRUE(tanks.fitter.pass(tanks.at, false, before));
  EXPECT_EQ(add_constant_to_function(tanks.at), 0u);
  ASSERT_EQ(tanks.at.terms.size(), 2u);
  EXPECT_EQ(tanks.at.terms[0].site, other.site) << "a function of another site does not contain it";
  ASSERT_TRUE(tanks.fitter.pass(tanks.at, false, after));
  for (size_t i = 0; i < before.error.size(); ++i) ASSERT_NEAR(after.error[i], before.error[i], 1e-12) << i;
  EXPECT_FALSE(add_constant_to_function(tanks.at));
}

}  // namespace
}  // namespace loopwright::diagnosis::site_screening_test
