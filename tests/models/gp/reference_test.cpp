// Comparison with scikit-learn, an independent implementation: the Debian package python3-sklearn, run as a
// child.
#include <gtest/gtest.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include "models/gp/dense.h"
#include "models/gp/structured.h"
#include "tests/models/gp/disturbance.h"
#include "tools/report/child_process.h"
#include "where.h"

namespace loopwright::gp::reference_test {
namespace {

using nlohmann::json;
constexpr const char* python = "/usr/bin/python3";  // the interpreter of Debian's packages

json case_of(const Kernel& kernel, const Samples& samples, const std::vector<Point>& points) {
  json terms = json::array();
  for (const Term& term : kernel.terms) {
    json along = json::array();
    for (const Shape& s : term.along)
      along.push_back(
          {{"kind", names_of(s.kind)[size_t(s.kind)]}, {"length", s.length}, {"period", s.period}});
    terms.push_back({{"deviation", term.deviation}, {"along", along}});
  }
  return {{"terms", terms},
          {"noise", kernel.noise},
          {"inputs", samples.inputs},
          {"labels", samples.labels},
          {"points", points}};
}

TEST(ScikitLearn, FindsTheSameEvidenceGradientMeanAndVariance) {
  if (!report::run_program({python, "-c", "import sklearn"}, "", std::chrono::minutes(2)).succeeded)
    GTEST_SKIP() << "scikit-learn is not installed (Debian package python3-sklearn)";
  std::stringstream script;
  script << std::ifstream(LOOPWRIGHT_SOURCE "/tests/models/gp/reference.py").rdbuf();
  const Samples samples = disturbance(200, Velocities::few);
  std::vector<Point> points;
  for (int i = 0; i < 40; ++i) points.push_back({-0.1 + 0.0173 * i, 0.02 * i});
  for (const Kernel& kernel : {additive(), double_smooth(), product(), smooth_product_and_constant()}) {
    const auto answer = report::run_program({python, "-c", script.str()},
                                            case_of(kernel, samples, points).dump(), std::chrono::minutes(5));
    ASSERT_TRUE(answer.succeeded) << answer.failure;
    const json theirs = json::parse(answer.output);
    std::string why_not;
    const auto statistics = summarise(kernel, {kernel.terms[0].along[0].length, 0.1}, samples, why_not);
    ASSERT_TRUE(statistics) << why_not;
    const Evidence ours = StructuredEvidence(*statistics)(kernel);
    EXPECT_NEAR(ours.value, theirs["value"].get<double>(), 1e-6);
    ASSERT_EQ(ours.gradient.size(), theirs["gradient"].size());
    for (size_t i = 0; i < ours.gradient.size(); ++i) {
      const double slope = theirs["gradient"][i];
      EXPECT_NEAR(ours.gradient[i], slope, 1e-6 * std::max(1.0, std::abs(slope)))
          << parameter_names(kernel)[i];
    }
    const StructuredPosterior posterior(kernel, *statistics);
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(posterior.mean(points[i]), theirs["mean"][i].get<double>(), 1e-6);
      EXPECT_NEAR(posterior.variance(points[i]), theirs["variance"][i].get<double>(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace loopwright::gp::reference_test
