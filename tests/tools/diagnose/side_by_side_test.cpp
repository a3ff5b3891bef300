// Fits on several threads, each with a model of its own, are the fits of one model in turn.
#include <gtest/gtest.h>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/search/site_fit.h"
#include "tools/diagnose/search/site_start.h"

namespace loopwright::side_by_side_test {
namespace {

using namespace diagnosis;

class SideBySide : public testing::Test {
 protected:
  SideBySide() { EXPECT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, start)); }

  /// With each parameter free by itself.
  std::vector<SiteHypothesis> candidates() const {
    std::vector<SiteHypothesis> list(model.parameters().size(), start);
    for (size_t i = 0; i < list.size(); ++i) list[i].is_free[i] = true;
    return list;
  }
  static void fit(SiteFitter& by, SiteHypothesis& h) { by.refine(h, 3), by.fit_noise(h); }
  std::vector<SiteHypothesis> fitted_in_turn() {
    std::vector<SiteHypothesis> list = candidates();
    for (SiteHypothesis& h : list) fit(fitter, h);
    return list;
  }
  std::vector<SiteHypothesis> fitted_side_by_side() {
    std::vector<SiteHypothesis> list = candidates();
    fitter.side_by_side(list.size(), [&](SiteFitter& own, size_t i) { fit(own, list[i]); });
    return list;
  }
  void expect_alike() {
    const double begin = model.work().done();
    const std::vector<SiteHypothesis> one = fitted_in_turn();
    const double middle = model.work().done();
    const std::vector<SiteHypothesis> other = fitted_side_by_side();
    ASSERT_GE(one.size(), 5u);
    for (size_t i = 0; i < one.size(); ++i) {
      SCOPED_TRACE(model.parameters()[i].name);
      EXPECT_NE(one[i].factors[i], 1);
      EXPECT_EQ(one[i].factors, other[i].factors);
      EXPECT_EQ(one[i].objective, other[i].objective);
      EXPECT_EQ(one[i].noise.process, other[i].noise.process);
    }
    EXPECT_EQ(model.work().done() - middle, middle - begin) << "operations";
  }

  RecordedPlant files{motor({}, 5)};
  SiteModel model{files.diagram(), {files.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().held_out_from, [] { return false; }};
  SiteHypothesis start;
};

TEST_F(SideBySide, FitsHaveTheSameBitsAndTheSameWork) { expect_alike(); }

TEST_F(SideBySide, WhatIsSupposedLaterIsSupposedByAll) {
  fitted_side_by_side();  // models of other threads exist
  const std::vector<SiteHypothesis> before = fitted_in_turn();
  std::vector<double> weaker = model.record().inputs[0].value;
  for (double& u : weaker) u *= 0.9;
  model.suppose_input(0, weaker);
  model.set_substeps(2 * model.substeps());
  expect_alike();
  EXPECT_NE(fitted_in_turn().front().objective, before.front().objective);
}

TEST_F(SideBySide, AFitThatThrowsEndsAll) {
  EXPECT_THROW(fitter.side_by_side(4,
                                   [](SiteFitter&, size_t i) {
                                     if (i == 2) throw std::runtime_error("no");
                                   }),
               std::runtime_error);
}

}  // namespace
}  // namespace loopwright::side_by_side_test
