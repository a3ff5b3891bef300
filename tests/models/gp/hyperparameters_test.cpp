#include "models/gp/hyperparameters.h"
#include <gtest/gtest.h>
#include "models/gp/dense.h"
#include "models/gp/structured.h"
#include "tests/models/gp/disturbance.h"

namespace loopwright::gp::hyperparameters_test {
namespace {

const DataScale scale{0.55, pitch, 0.45, 0.05};

Fit fitted(const Kernel& kernel, const Samples& samples) {
  const std::vector<Prior> priors = default_priors(kernel, scale);
  std::string why_not;
  const auto statistics = summarise(at_medians(kernel, priors), {0.25, 0.05}, samples, why_not);
  StructuredEvidence evidence(*statistics);
  return fit(std::ref(evidence), at_medians(kernel, priors), priors);
}

TEST(Fit, EndsWhereNoDirectionIsBetter) {
  for (const Kernel& kernel : {additive(), product()}) {
    const Samples samples = disturbance(1500, Velocities::few);
    const Fit result = fitted(kernel, samples);
    EXPECT_TRUE(result.converged);
    const std::vector<Prior> priors = default_priors(kernel, scale);
    const Evidence prior = log_prior(priors, parameters_of(result.kernel));
    for (size_t i = 0; i < priors.size(); ++i) {
      ASSERT_FALSE(is_at_limit(priors[i], parameters_of(result.kernel)[i]));
      EXPECT_NEAR(result.evidence.gradient[i] + prior.gradient[i], 0, 0.02) << parameter_names(kernel)[i];
    }
  }
}

TEST(Fit, FindsTheNoiseThatTheSamplesHave) {
  const double noise = 0.02;
  const Fit result = fitted(product(), disturbance(3000, Velocities::few, noise));
  EXPECT_NEAR(result.kernel.noise, noise, 4 * noise / std::sqrt(2.0 * 3000));  // four standard errors
}

TEST(Fit, GivesTheSameBitsAgain) {
  const Samples samples = disturbance(400, Velocities::few);
  EXPECT_EQ(fitted(additive(), samples).kernel, fitted(additive(), samples).kernel);
}

TEST(Fit, TheDensePathEndsAtTheSamePlace) {
  const Samples samples = disturbance(120, Velocities::few);
  const std::vector<Prior> priors = default_priors(additive(), scale);
  const auto dense = [&](const Kernel& kernel) { return dense_evidence(kernel, samples); };
  const Fit whole = fit(dense, at_medians(additive(), priors), priors),
            structured = fitted(additive(), samples);
  for (size_t i = 0; i < priors.size(); ++i)
    EXPECT_NEAR(std::log(parameters_of(whole.kernel)[i] / parameters_of(structured.kernel)[i]), 0, 1e-3);
}

TEST(LogPrior, HasTheGradientOfItsDifferences) {
  const std::vector<Prior> priors{{2, 0.7, 0.1, 50}};
  const double p = 3, h = 1e-5;
  const auto value = [&](double x) { return log_prior(priors, std::array{x}).value; };
  EXPECT_NEAR(log_prior(priors, std::array{p}).gradient[0],
              (value(p * std::exp(h)) - value(p * std::exp(-h))) / (2 * h), 1e-8);
  EXPECT_EQ(log_prior(priors, std::array{2.0}).gradient[0], 0);
}

TEST(DefaultPriors, KeepTheVelocityLengthFromLearningEachVelocityByItself) {
  const std::vector<Prior> priors = default_priors(additive(), scale);
  EXPECT_EQ(parameter_names(additive())[3], "terms.1.velocity.length");
  EXPECT_GE(priors[3].low, scale.velocity_step);
}

}  // namespace
}  // namespace loopwright::gp::hyperparameters_test
