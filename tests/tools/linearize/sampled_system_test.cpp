#include <gmock/gmock.h>
#include <cmath>
#include "tests/engine/written_diagram.h"
#include "tools/linearize/linear_diagram.h"

namespace loopwright::sampled_system_test {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVector2d;
using Eigen::Vector2d;
using testing::Contains;
using testing::HasSubstr;

SampledSystem sampled(const std::string& text, const Access& access, double sample_time = 0) {
  const auto plan = plan_of(text);
  return sampled_system(linearize_at_start(*plan), access, sample_time);
}

/// The output at samples 0, 1, … after a pulse of one sample, from one input to one output.
std::vector<double> pulse_response(const StateSpace& s, int samples) {
  std::vector<double> y{s.D(0, 0)};
  MatrixXd x = s.B;
  for (int k = 1; k < samples; ++k, x = s.A * x) y.push_back((s.C * x)(0, 0));
  return y;
}

std::vector<double> response_of(const std::string& block, const std::string& output, int samples) {
  return pulse_response(
      sampled(diagram(R"("u": {"type": "Constant", "value": 0.3}, "b": )" + block), {{"u.y"}, {output}, {}})
          .matrices,
      samples);
}

void expect_near(const std::vector<double>& found, const std::vector<double>& wanted,
                 double tolerance = 1e-13) {
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], tolerance) << "sample " << i;
}

TEST(SampledBlocks, DelaysAndWindowsRespondAsTheirNamesSay) {
  expect_near(response_of(R"({"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "u.y"}})", "b.y", 3),
              {0, 1, 0});
  expect_near(
      response_of(R"({"type": "Delay", "samples": 3, "sample_time": 0.1, "in": {"u": "u.y"}})", "b.y", 6),
      {0, 0, 0, 1, 0, 0});
  expect_near(
      response_of(R"({"type": "MovingAverage", "samples": 4, "sample_time": 0.1, "in": {"u": "u.y"}})", "b.y",
                  6),
      {0.25, 0.25, 0.25, 0.25, 0, 0});
  expect_near(response_of(R"({"type": "VelocityEstimator", "method": "backward_difference", "samples": 2,
                              "sample_time": 0.1, "in": {"position": "u.y"}})",
                          "b.velocity", 5),
              {5, 0, -5, 0, 0});
}

TEST(SampledBlocks, ATransferFunctionRespondsByItsOwnRecursion) {
  // y[k] = 0.5 y[k-1] + 2 u[k] - u[k-1]
  expect_near(
      response_of(R"({"type": "DiscreteTransferFunction", "numerator": [2, -1], "denominator": [1, -0.5],
                              "sample_time": 0.1, "in": {"u": "u.y"}})",
                  "b.y", 4),
      {2, 0, 0, 0});
}

const char* const held_mass = R"(
  "sensor": {"type": "ZeroOrderHold", "sample_time": 0.01, "in": {"u": "mass.position"}},
  "gain": {"type": "Gain", "gain": -50, "in": {"u": "sensor.y"}},
  "mass": {"type": "Mass", "mass": 2, "in": {"force": "gain.y"}})";

TEST(SampledSystem, AHeldFeedbackOfAMassHasItsKnownMatrix) {
  const SampledSystem system = sampled(diagram(held_mass), {{"mass.force"}, {"mass.position"}, {}});
  const double T = 0.01;
  MatrixXd A(2, 2), B(2, 1);
  A << 1, T, 0, 1;
  B << T * T / 4, T / 2;
  EXPECT_TRUE(system.matrices.A.isApprox(A - 50 * B * RowVector2d(1, 0), 1e-14)) << system.matrices.A;
  EXPECT_TRUE(system.matrices.B.isApprox(B, 1e-14));
  EXPECT_EQ(system.matrices.sample_time, T);
  EXPECT_EQ(system.lifted, 1);
}

TEST(SampledSystem, ACutFeedbackIsTheHeldPlant) {
  const SampledSystem system = sampled(diagram(held_mass), {{"gain.u"}, {"sensor.y"}, {"gain.u"}});
  EXPECT_NEAR(system.matrices.A(1, 0), 0, 1e-15);
  EXPECT_NEAR(system.matrices.B(1, 0), -50 * 0.005, 1e-15);
}

TEST(SampledSystem, SignalsThatAreAddedAtTheSampleAreSeenAtTheSample) {
  const SampledSystem system = sampled(diagram(held_mass), {{"sensor.u"}, {"sensor.y", "gain.y"}, {}});
  EXPECT_EQ(system.matrices.D(0, 0), 1);
  EXPECT_EQ(system.matrices.D(1, 0), -50);
}

TEST(SampledSystem, TwoRatesAreLiftedOverTheirCommonPeriod) {
  // A lag x' = u - x. The fast sampler runs at T, the slow one at 2 T; their sum drives the lag.
  const SampledSystem system = sampled(diagram(R"(
    "fast": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "lag.y"}},
    "slow": {"type": "ZeroOrderHold", "sample_time": 0.2, "in": {"u": "lag.y"}},
    "sum": {"type": "Expression", "formula": "-2*a - 3*b", "names": ["a", "b"], "in": {"arguments": ["fast.y", "slow.y"]}},
    "lag": {"type": "LowPass", "order": 1, "cutoff": 1, "in": {"u": "sum.y"}})"),
                                       {{"lag.u"}, {"lag.y"}, {}});
  EXPECT_EQ(system.lifted, 2);
  EXPECT_DOUBLE_EQ(system.matrices.sample_time, 0.2);
  const double a = std::exp(-0.1), b = 1 - a;
  const double half = a - 2 * b,
               first = half - 3 * b;  // x[1] = (a - 2b - 3b) x[0]; x[2] = (a - 2b) x[1] - 3b x[0]
  ASSERT_EQ(system.matrices.A.rows(), 1);
  EXPECT_NEAR(system.matrices.A(0, 0), half * first - 3 * b, 1e-13);
  EXPECT_NEAR(system.matrices.B(0, 0), half * b, 1e-13);
  EXPECT_NEAR(system.matrices.B(0, 1), b, 1e-13);
  EXPECT_NEAR(system.matrices.C(1, 0), first, 1e-13);
  EXPECT_NEAR(system.matrices.D(1, 0), b, 1e-13);
}

TEST(SampledSystem, WhatARateWithAnOffsetHoldsOverTheStartOfThePeriodIsAState) {
  const SampledSystem system = sampled(diagram(R"(
    "early": {"type": "ZeroOrderHold", "sample_time": 0.2, "in": {"u": "lag.y"}},
    "late": {"type": "ZeroOrderHold", "sample_time": 0.2, "sample_offset": 0.1, "in": {"u": "lag.y"}},
    "minus": {"type": "Gain", "gain": -1, "in": {"u": "late.y"}},
    "lag": {"type": "LowPass", "order": 1, "cutoff": 1, "in": {"u": "minus.y"}})"),
                                       {{}, {"early.y"}, {}});
  const double a = std::exp(-0.1), b = 1 - a;
  ASSERT_THAT(system.states, Contains(HasSubstr("(held)")));
  // x[1] = a x - b h; h := x[1]; x[2] = a x[1] - b x[1]; `late` is held, and `minus` follows from it.
  MatrixXd start = MatrixXd::Zero(system.matrices.states(), 1);
  start(0, 0) = 1;
  EXPECT_NEAR((system.matrices.A * start)(0, 0), (a - b) * a, 1e-13);
  EXPECT_NEAR(system.matrices.A.trace(), (a - b) * a - b, 1e-13) << "what was held acts until it is replaced";
}

TEST(SampledSystem, ATransportDelayOfAHeldSignalIsExact) {
  // 1.4 samples: the plant gets u[k-2] for the first 0.4 of the interval, u[k-1] for the rest.
  const SampledSystem system = sampled(diagram(R"(
    "u": {"type": "Constant", "value": 0},
    "hold": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "u.y"}},
    "delay": {"type": "TransportDelay", "delay": 0.14, "in": {"u": "hold.y"}},
    "lag": {"type": "LowPass", "order": 1, "cutoff": 3, "in": {"u": "delay.y"}})"),
                                       {{"hold.u"}, {"lag.y"}, {}});
  const double early = 1 - std::exp(-3 * 0.06), decay = std::exp(-0.3),
               late = (1 - std::exp(-3 * 0.04)) * std::exp(-3 * 0.06);
  expect_near(pulse_response(system.matrices, 5),
              {0, 0, early, early * decay + late, (early * decay + late) * decay});
}

TEST(SampledSystem, AContinuousDiagramIsSampledAsAsked) {
  const SampledSystem system = sampled(
      diagram(
          R"("u": {"type": "Constant", "value": 0}, "lag": {"type": "LowPass", "order": 1, "cutoff": 3, "in": {"u": "u.y"}})"),
      {{"u.y"}, {"lag.y"}, {}}, 0.1);
  EXPECT_NEAR(system.matrices.A(0, 0), std::exp(-0.3), 1e-14);
  EXPECT_NEAR(system.matrices.B(0, 0) * system.matrices.C(0, 0), 1 - std::exp(-0.3), 1e-14);
}

TEST(SampledSystem, AQuantizerIsAStraightLineAndAReaderIsToldSo) {
  const auto plan = plan_of(diagram(R"(
    "x": {"type": "Constant", "value": 0.0123456},
    "encoder": {"type": "Encoder", "sample_time": 0.01, "resolution": 2e-7, "in": {"position": "x.y"}},
    "round": {"type": "Quantizer", "sample_time": 0.01, "resolution": 0.25, "in": {"u": "x.y"}},
    "relay": {"type": "Relay", "switch_on": 1, "switch_off": -1, "sample_time": 0.01, "in": {"u": "x.y"}})"));
  const LinearDiagram linear = linearize_at_start(*plan);
  const SampledSystem system =
      sampled_system(linear, {{"x.y"}, {"encoder.position", "round.y", "relay.y"}, {}});
  EXPECT_NEAR(system.matrices.D(0, 0), 1, 1e-8);
  EXPECT_NEAR(system.matrices.D(1, 0), 1, 1e-12);
  EXPECT_EQ(system.matrices.D(2, 0), 0);
  const auto kind_of = [&](std::string_view block) {
    std::vector<LinearizationNote::Kind> kinds;
    for (const LinearizationNote& note : linear.notes)
      if (note.block == block) kinds.push_back(note.kind);
    return kinds;
  };
  EXPECT_THAT(kind_of("encoder"), testing::ElementsAre(LinearizationNote::Kind::staircase));
  EXPECT_THAT(kind_of("round"), testing::ElementsAre(LinearizationNote::Kind::staircase));
  EXPECT_THAT(kind_of("relay"), Contains(LinearizationNote::Kind::flat));
}

TEST(SampledSystem, ALimiterAtItsLimitPassesNothingAndAReaderIsToldSo) {
  const auto plan = plan_of(diagram(R"(
    "u": {"type": "Constant", "value": 12},
    "limit": {"type": "Saturation", "low": -10, "high": 10, "in": {"u": "u.y"}})"));
  const LinearDiagram linear = linearize_at_start(*plan);
  EXPECT_EQ(continuous_part(linear, {{"u.y"}, {"limit.y"}, {}}).matrices.D(0, 0), 0);
  ASSERT_EQ(linear.notes.size(), 1u);
  EXPECT_EQ(linear.notes[0].text, "limit.y does not follow limit.u here");
}

TEST(SampledSystem, HasTheRatesOfTheDiagramAndNoOther) {
  const std::string text = diagram(
      R"("u": {"type": "Constant", "value": 0.3}, "b": {"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "u.y"}})");
  EXPECT_NEAR(sampled(text, {{"u.y"}, {"b.y"}, {}}, 0.1).matrices.sample_time, 0.1, 1e-15);
  try {
    sampled(text, {{"u.y"}, {"b.y"}, {}}, 0.01);
    FAIL() << "another sample time is taken";
  } catch (const InputError& error) {
    for (const char* part : {"0.1 s", "0.01 s", "--continuous"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace loopwright::sampled_system_test
