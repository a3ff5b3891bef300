// Log evidence, gradient, mean and variance: the structured computation against whole matrices, both against
// differences.
#include <gtest/gtest.h>
#include "models/gp/dense.h"
#include "models/gp/structured.h"
#include "tests/models/gp/disturbance.h"

namespace loopwright::gp::evidence_test {
namespace {

struct Case {
  std::string name;
  Kernel kernel;
  Velocities velocities;
};

Statistics summarised(const Kernel& kernel, const Samples& samples) {
  std::string why_not;
  const auto statistics = summarise(kernel, {kernel.terms[0].along[0].length, 0.1}, samples, why_not);
  if (!statistics) throw std::runtime_error(why_not);
  return *statistics;
}

class EvidenceOf : public testing::TestWithParam<Case> {
 protected:
  const Kernel& kernel() const { return GetParam().kernel; }
  Samples samples() const { return disturbance(150, GetParam().velocities); }
};

TEST_P(EvidenceOf, StructureIsTheWholeMatrixOne) {
  const Samples data = samples();
  const Statistics statistics = summarised(kernel(), data);
  const Evidence dense = dense_evidence(kernel(), data),
                 structured = StructuredEvidence(statistics)(kernel());
  EXPECT_NEAR(structured.value, dense.value, 1e-9);
  ASSERT_EQ(structured.gradient.size(), dense.gradient.size());
  for (size_t i = 0; i < dense.gradient.size(); ++i)
    EXPECT_NEAR(structured.gradient[i], dense.gradient[i], 1e-8 * std::abs(dense.gradient[i]))
        << parameter_names(kernel())[i];
}

TEST_P(EvidenceOf, GradientIsThatOfDifferences) {
  const Samples data = samples();
  const Evidence here = dense_evidence(kernel(), data);
  const std::vector<double> parameters = parameters_of(kernel());
  for (size_t i = 0; i < parameters.size(); ++i) {
    const double h = 1e-4;  // in the logarithm; fourth-order differences: error h⁴/30 of a fifth derivative
    const auto value = [&](double steps) {
      std::vector<double> moved = parameters;
      moved[i] *= std::exp(steps * h);
      return dense_evidence(with_parameters(kernel(), moved), data).value;
    };
    const double slope = (8 * (value(1) - value(-1)) - (value(2) - value(-2))) / (12 * h);
    EXPECT_NEAR(here.gradient[i], slope, 1e-6 * std::max(1.0, std::abs(slope)))
        << parameter_names(kernel())[i];
  }
}

TEST_P(EvidenceOf, PredictionsAreThoseOfTheWholeMatrix) {
  const Samples data = samples();
  const DensePosterior dense(kernel(), data);
  const StructuredPosterior structured(kernel(), summarised(kernel(), data));
  for (double v : {-0.4, 0.0, 0.05, 0.13, 0.5, 0.9})
    for (double x = -0.3; x < 0.8; x += 0.00731) {
      EXPECT_NEAR(structured.mean({x, v}), dense.mean({x, v}), 1e-9);
      EXPECT_NEAR(structured.variance({x, v}), dense.variance({x, v}), 1e-9);
    }
}

TEST_P(EvidenceOf, SlopesOfTermsAreThoseOfDifferences) {
  const Samples data = samples();
  const DensePosterior dense(kernel(), data);
  const StructuredPosterior structured(kernel(), summarised(kernel(), data));
  const double hx = 1e-6, hv = 1e-5;
  for (size_t t = 0; t < kernel().terms.size(); ++t) {
    EXPECT_NEAR(structured.term_norm(t), dense.term_norm(t), 1e-7 * (1 + dense.term_norm(t)));
    for (const Point p : {Point{0.1234, 0.13}, {0.3, 0.44}, {0.0871, -0.1}}) {
      const Jet jet = structured.term(t, p), whole = dense.term(t, p);
      const auto f = [&](double dx, double dv) { return dense.term(t, {p[0] + dx, p[1] + dv})[0]; };
      EXPECT_NEAR(jet[0], f(0, 0), 1e-9);
      const double by_x = (f(hx, 0) - f(-hx, 0)) / (2 * hx), by_v = (f(0, hv) - f(0, -hv)) / (2 * hv);
      EXPECT_NEAR(whole[1], by_x, 1e-4 * (1 + std::abs(by_x)));
      EXPECT_NEAR(whole[2], by_v, 1e-4 * (1 + std::abs(by_v)));
      for (size_t k = 1; k < 4; ++k) EXPECT_NEAR(jet[k], whole[k], 1e-6 * (1 + std::abs(whole[k])));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, EvidenceOf,
                         testing::Values(Case{"Additive", additive(), Velocities::few},
                                         Case{"AdditiveContinuous", additive(), Velocities::continuous},
                                         Case{"DoubleSmooth", double_smooth(), Velocities::few},
                                         Case{"Product", product(), Velocities::few},
                                         Case{"ProductContinuous", product(), Velocities::continuous},
                                         Case{"SmoothProduct", smooth_product_and_constant(),
                                              Velocities::few}),
                         [](const auto& test) { return test.param.name; });

TEST(Statistics, CostNothingMoreWithMoreSamples) {
  const Statistics few = summarised(additive(), disturbance(500, Velocities::few)),
                   many = summarised(additive(), disturbance(5000, Velocities::few));
  EXPECT_EQ(few.moments.size(), many.moments.size());
  EXPECT_EQ(many.count, 5000u);
}

TEST(Statistics, AreRefusedWithAReasonWhereTheKernelHasNoStructure) {
  const Samples data = disturbance(50, Velocities::few);
  std::string why_not;
  Kernel kernel = additive();
  kernel.terms.push_back(Term{0.1, {smooth(0.1), Shape{}}});
  EXPECT_FALSE(summarise(kernel, {0.1, 0.1}, data, why_not));
  EXPECT_EQ(why_not, "the terms see the position in different ways");
  kernel.terms.back().along[0] = periodic(1, 0.03);
  EXPECT_FALSE(summarise(kernel, {0.1, 0.1}, data, why_not));
  EXPECT_FALSE(summarise(additive(), {0.1, 0.1}, {}, why_not));
  EXPECT_EQ(why_not, "there are no samples");
}

TEST(PeriodicWeights, SumToTheKernelAndItsSlope) {
  for (double length : {0.2, 0.7, 2.0, 20.0}) {
    const Shape shape = periodic(length);
    const PeriodicWeights weights = periodic_weights(length, size_for({Basis::Kind::fourier}, length));
    for (double r = 0; r < pitch; r += 0.00101) {
      double value = weights.value[0], slope = weights.slope[0];
      for (size_t i = 1; i < weights.value.size(); i += 2) {
        const double cosine = std::cos(2 * std::numbers::pi * double((i + 1) / 2) * r / pitch);
        value += weights.value[i] * cosine, slope += weights.slope[i] * cosine;
      }
      EXPECT_NEAR(value, correlation(shape, r), 1e-14);
      EXPECT_NEAR(slope, length_slope(shape, r), 2e-13);
    }
  }
}

}  // namespace
}  // namespace loopwright::gp::evidence_test
