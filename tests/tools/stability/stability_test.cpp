#include "tools/stability/stability.h"
#include <gmock/gmock.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include "engine/run/require_finished.h"
#include "tests/blocks/learning/trained_model.h"
#include "tests/engine/written_diagram.h"
#include "tools/linearize/analysis.h"
#include "tools/stability/certificates.h"

namespace loopwright::stability_test {
namespace {

using testing::HasSubstr;

/// The paper's loop in continuous time, rigid plant, no delay, viscous friction 2.4; `delay` in the command.
std::string continuous_loop(const std::string& command = "limit.sum", const std::string& more = "") {
  return diagram(fmt::format(R"(
  "reference": {{"type": "Sine", "amplitude": 0.01, "frequency": 1}},
  "feedback": {{"type": "ContinuousPdController", "Kp": 4056.6, "Kd": 62.21, "derivative_pole": 942.48,
               "in": {{"reference": "reference.y", "measured": "plant.position"}}}},
  "observer": {{"type": "ContinuousDisturbanceObserver", "mass": 0.2621, "damping": 3, "cutoff": 251.327,
               "in": {{"measured": "plant.position", "command": "{0}"}}}},
  "limit": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["feedback.command", "observer.disturbance"]}}}},
  {1}
  "force": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["{0}", "friction.force"]}}}},
  "friction": {{"type": "ViscousFriction", "damping": 2.4, "in": {{"velocity": "plant.velocity"}}}},
  "plant": {{"type": "Mass", "mass": 0.2621, "in": {{"force": "force.sum"}}}})",
                             command, more),
                 R"("stop": 1, "step": 0.0001, "algebraic_loops": "solve")");
}

StabilityReport assess(const std::string& text, const StabilityRequest& request = {}) {
  DiagramFolder folder;
  return assess_stability(folder.with("top.json", text).path("top.json"), {}, request);
}

TEST(PaperCondition, ConstantsOfTheContinuousLoopAreThoseOfItsReconstruction) {
  StabilityRequest request;
  request.kicks = false;
  const StabilityReport report = assess(continuous_loop(), request);
  EXPECT_EQ(report.disturbance, "plant.force");
  ASSERT_TRUE(report.paper);
  const PaperCondition& c = *report.paper;
  EXPECT_NEAR(c.gamma_dx, 2.465e-4, 0.005e-4);
  EXPECT_NEAR(c.gamma_q, 3.72e4, 0.04e4);
  EXPECT_NEAR(c.gain_q, 1, 1e-3);
  EXPECT_NEAR(c.gamma_xu, 1.21e5, 0.01e5);
  EXPECT_NEAR(c.rho_corrected, 2.465e-4 * (3.72e4 + 1.21e5), 0.5);
}

TEST(PaperCondition, CannotHoldForAnyControllerWithAnObserver) {
  StabilityRequest request;
  request.kicks = false;
  const PaperCondition c = *assess(continuous_loop(), request).paper;
  EXPECT_NEAR(c.least_rho, 1 + 0.2621 * std::pow(251.327, 2) / 4056.6, 0.01);
  EXPECT_GT(c.least_rho, 1);
  EXPECT_LT(c.least_rho, c.rho_corrected);
}

TEST(Loop, MsOfTheReconstructedLoopGrowsWithItsDelayAsPublished) {
  for (const auto& [delay, Ms] : {std::pair{0.0005, 1.61}, std::pair{0.0015, 2.39}}) {
    const auto plan = plan_of(continuous_loop(
        "late.y",
        fmt::format(R"("late": {{"type": "TransportDelay", "delay": {}, "in": {{"u": "limit.sum"}}}},)",
                    delay)));
    LinearizeRequest request;
    request.break_point = "force.terms[0]";
    EXPECT_NEAR(analyse(*plan, request).loop->margins.Ms, Ms, 0.01) << delay;
  }
}

/// d → x of the whole continuous loop, then F_gp, and F_v for the velocity.
const char* const learned_path = R"(
  "compensation": {"type": "LowPass", "order": 1, "cutoff": 628.3185, "in": {"u": "prediction.y"}},
  "prediction": {"type": "Constant", "value": 0},
  "velocity": {"type": "Derivative", "cutoff": 314.1593, "in": {"u": "plant.position"}},)";

TEST(Certificates, OfTheContinuousLoopAreThoseOfItsReconstruction) {
  std::string text = continuous_loop("limit.sum", learned_path);
  const std::string forces = R"("signs": "+-", "in": {"terms": ["limit.sum", "friction.force")";
  text.replace(text.find(forces), forces.size(),
               R"("signs": "+--", "in": {"terms": ["limit.sum", "friction.force", "compensation.y")");
  const auto plan = plan_of(text);
  const LinearDiagram linear = linearize_at_start(*plan);
  const LinearSystem G = continuous_part(linear, {{"plant.force"}, {"plant.position"}, {}});
  EXPECT_NEAR(gain_bound(hold_discretization(G.matrices, 1e-5), GainOf::peak), 1.51e-4, 0.01e-4);
  const std::vector<BoundedFunction> functions{
      {"prediction.y", {{{{"plant.position", 1.0}}, 229}, {{{"velocity.y", 1.0}}, 0.87}}, true}};
  const auto certificate = [&](GainOf gain) {
    return certify(small_gain_matrix(linear, functions, 1, 1e-4, 1, gain), functions, 0.95);
  };
  EXPECT_NEAR(certificate(GainOf::peak).radius, 0.0485, 0.0005);
  EXPECT_NEAR(certificate(GainOf::peak).largest_alpha, 19.6, 0.2);
  EXPECT_LE(certificate(GainOf::energy).radius, certificate(GainOf::peak).radius);
  EXPECT_GE(certificate(GainOf::energy).radius, 0.0313) << "no less than the peak of both inputs together";
}

TEST(Certificates, OneFunctionScalesWithAlphaAndAnotherDoesNot) {
  const std::vector<BoundedFunction> functions{{"learned", {}, true}, {"plant", {}, false}};
  Eigen::MatrixXd gains(2, 2);
  gains << 0.2, 0.3, 0.1, 0.5;
  const Certificate certificate = certify(gains, functions, 1);
  // det(1 - N) = (1 - 0.2 α)(1 - 0.5) - 0.03 α = 0 at the largest α.
  EXPECT_NEAR(certificate.largest_alpha, 0.5 / 0.13, 1e-9);
  EXPECT_NEAR(certificate.radius_without, 0.5, 1e-12);
  EXPECT_TRUE(certificate.holds);
  gains(1, 1) = 1.1;
  EXPECT_EQ(certify(gains, functions, 1).largest_alpha, 0);
}

/// The paper's loop as a sampled system, with cogging, and a learned block.
std::string sampled_loop(const std::string& model, double Kd = 62.21, const std::string& stiction = "0") {
  return diagram(fmt::format(R"(
  "reference": {{"type": "Sine", "amplitude": 0.05, "frequency": 1, "sample_time": 0.001}},
  "sensor": {{"type": "ZeroOrderHold", "sample_time": 0.001, "in": {{"u": "mass.position"}}}},
  "feedback": {{"type": "PdController", "sample_time": 0.001, "Kp": 4056.6, "Kd": {1}, "derivative_pole": 942.48,
               "in": {{"reference": "reference.y", "measured": "sensor.y"}}}},
  "observer": {{"type": "DisturbanceObserver", "sample_time": 0.001, "mass": 0.2621, "damping": 3, "cutoff": 251.327,
               "in": {{"measured": "sensor.y", "command": "observed.sum"}}}},
  "estimator": {{"type": "VelocityEstimator", "sample_time": 0.001, "cutoff": 314.16, "in": {{"position": "sensor.y"}}}},
  "gpr": {{"type": "Gpr", "model": "{0}", "lead": 0.0025, "in": {{"position": "sensor.y", "velocity": "estimator.velocity"}}}},
  "filter": {{"type": "CompensationFilter", "sample_time": 0.001, "cutoff": 628.3, "weight": 0.95, "ramp_time": 0.1,
             "in": {{"prediction": "gpr.prediction"}}}},
  "command": {{"type": "Sum", "signs": "+--", "in": {{"terms": ["feedback.command", "observer.disturbance", "filter.compensation"]}}}},
  "observed": {{"type": "Sum", "in": {{"terms": ["command.sum", "filter.compensation"]}}}},
  "force": {{"type": "Sum", "signs": "+---", "in": {{"terms": ["command.sum", "viscous.force", "cogging.force", "stiction.force"]}}}},
  "viscous": {{"type": "ViscousFriction", "damping": 2.4, "in": {{"velocity": "mass.velocity"}}}},
  "cogging": {{"type": "CoggingForce", "pole_pitch": 0.0225, "harmonics": [{{"amplitude": 0.5}}],
              "in": {{"position": "mass.position"}}}},
  "stiction": {{"type": "CoulombFriction", "level": {2}, "mass": 0.2621, "in": {{"velocity": "mass.velocity"}}}},
  "mass": {{"type": "Mass", "mass": 0.2621, "in": {{"force": "force.sum"}}}})",
                             model, Kd, stiction),
                 R"("stop": 1, "step": 0.0005)");
}

TEST(Stability, ASampledLoopWithALearnedBlockIsCertifiedAndKicksDieOut) {
  const ModelFolder folder;
  const StabilityReport report = assess(sampled_loop(folder.path()));
  EXPECT_TRUE(report.is_certified()) << to_text(report);
  EXPECT_NEAR(report.alpha, 0.95, 1e-9);
  EXPECT_EQ(report.learned, "gpr");
  EXPECT_GT(report.peak.largest_alpha, 1);
  EXPECT_LE(report.energy.radius, report.peak.radius);
  EXPECT_GT(report.peak.radius, report.peak.radius_without);
  ASSERT_EQ(report.kicks.size(), 3u) << "at the diagram's alpha, at the largest certified and at twice that";
  for (const KickTest& kick : report.kicks)
    EXPECT_TRUE(kick.decays || kick.alpha > report.peak.largest_alpha);
  const auto cogging = std::ranges::find(report.nonlinearities, "cogging", &Nonlinearity::block);
  ASSERT_NE(cogging, report.nonlinearities.end());
  EXPECT_NEAR(cogging->inputs[0].deviation, 0.5 * 2 * M_PI / 0.0225, 0.5);
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_TRUE(json["certified"].get<bool>());
  EXPECT_NEAR(json["B"]["peak"]["largest_alpha"].get<double>(), report.peak.largest_alpha, 1e-9);
  EXPECT_NO_THROW(report::to_html(stability_page(report)));
}

TEST(Stability, AnUndampedLoopIsNeverCertified) {
  const ModelFolder folder;
  StabilityRequest request;
  request.kicks = false;
  const StabilityReport report = assess(sampled_loop(folder.path(), -20), request);
  EXPECT_FALSE(report.linear_part_is_stable());
  EXPECT_FALSE(report.is_certified());
  EXPECT_THAT(to_text(report), HasSubstr("UNSTABLE"));
}

TEST(Stability, FrictionThatJumpsIsLeftOutAndSaidSo) {
  const ModelFolder folder;
  StabilityRequest request;
  request.kicks = false;
  EXPECT_THAT(assess(sampled_loop(folder.path(), 62.21, "0.3"), request).warnings,
              testing::Contains(HasSubstr("stiction jumps")));
}

/// A loop beside an integral of its error, which nothing reads.
std::string with_recorded_error(const std::string& more) {
  return diagram(fmt::format(R"(
  "wanted": {{"type": "Step", "time": 0.1, "after": 0.001}},
  "pd": {{"type": "PdController", "sample_time": 0.001, "Kp": 1000, "Kd": 40, "derivative_pole": 1500,
         "in": {{"reference": "wanted.y", "measured": "mass.position"}}}},
  "mass": {{"type": "Mass", "mass": 1, "in": {{"force": "pd.command"}}}},
  "e": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["wanted.y", "mass.position"]}}}}{})",
                             more),
                 R"("stop": 1, "step": 0.0005)");
}

TEST(Stability, AnIntegralThatNothingReadsIsNamedAndNotJudged) {
  StabilityRequest request;
  request.kicks = false;
  const StabilityReport alone = assess(with_recorded_error(""), request);
  const StabilityReport report =
      assess(with_recorded_error(R"(, "iae": {"type": "Integrator", "in": {"u": "e.sum"}})"), request);
  EXPECT_TRUE(alone.is_certified()) << to_text(alone);
  EXPECT_TRUE(report.is_certified()) << to_text(report);
  EXPECT_NEAR(report.largest_pole, alone.largest_pole, 1e-9);
  EXPECT_TRUE(alone.warnings.empty());
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("(iae"));
  EXPECT_THAT(report.warnings[0], HasSubstr("does not decay"));
}

TEST(Stability, AnInterruptionIsNoFailure) {
  const std::atomic<bool> interrupt = true;
  RunOptions options;
  options.interrupt = &interrupt;
  DiagramFolder folder;
  folder.with("top.json", with_recorded_error(""));
  EXPECT_THROW(assess_stability(folder.path("top.json"), {}, {}, options), Interrupted);
}

TEST(Stability, ADiagramWithoutALoopIsRefused) {
  EXPECT_THROW(assess(diagram(R"("lag": {"type": "LowPass", "cutoff": 3, "in": {"u": "lag.y"}})")),
               InputError);
}

}  // namespace
}  // namespace loopwright::stability_test
