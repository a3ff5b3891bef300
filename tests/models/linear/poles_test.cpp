#include "models/linear/poles.h"
#include <gmock/gmock.h>
#include <cmath>
#include "models/linear/structure.h"

namespace loopwright::poles_test {
namespace {

using Eigen::MatrixXd;
using Complex = std::complex<double>;

/// Two masses (1 kg and 4 kg) and a spring (400 N/m) with a little damping; states x1 v1 x2 v2, force on 1.
StateSpace two_masses(double damping) {
  StateSpace s;
  s.A.resize(4, 4), s.B.resize(4, 1), s.C.resize(1, 4), s.D = MatrixXd::Zero(1, 1);
  s.A << 0, 1, 0, 0, -400, -damping, 400, damping, 0, 0, 0, 1, 100, damping / 4, -100, -damping / 4;
  s.B << 0, 1, 0, 0;
  s.C << 1, 0, 0, 0;
  return s;
}

TEST(Poles, AnOscillatorHasItsFrequencyAndDampingAndItsOwnStates) {
  StateSpace s;
  s.A = MatrixXd::Zero(3, 3);
  s.A << 0, 1, 0, -100, -2, 0, 0, 0, -3;
  s.B = MatrixXd::Zero(3, 1), s.C = MatrixXd::Zero(1, 3), s.D = MatrixXd::Zero(1, 1);
  const std::vector<Pole> found = poles(s);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0].value.real(), -3, 1e-12);
  EXPECT_NEAR(found[0].participation[2], 1, 1e-12);
  EXPECT_NEAR(found[1].frequency, 10, 1e-12);
  EXPECT_NEAR(found[1].damping, 0.1, 1e-12);
  EXPECT_NEAR(found[1].participation[0] + found[1].participation[1], 1, 1e-12);
  EXPECT_EQ(found[1].value, std::conj(found[2].value));
}

TEST(Poles, SampledPolesAreReadBackInContinuousTime) {
  StateSpace s;
  s.A.resize(2, 2);
  const Complex z = std::exp(Complex(-1, 20) * 0.01);
  s.A << z.real(), z.imag(), -z.imag(), z.real();
  s.B = MatrixXd::Zero(2, 1), s.C = MatrixXd::Zero(1, 2), s.D = MatrixXd::Zero(1, 1);
  s.sample_time = 0.01;
  EXPECT_NEAR(std::abs(poles(s)[0].continuous - Complex(-1, 20)), 0, 1e-12);
  EXPECT_TRUE(is_stable(s));
}

TEST(Poles, StatesOfVeryDifferentSizeCostNoDigits) {
  StateSpace s = two_masses(0.2);
  const std::vector<Pole> before = poles(s);
  const Eigen::Vector4d scale(1e-9, 1, 1e6, 1e12);
  s.A = scale.asDiagonal() * s.A * scale.cwiseInverse().asDiagonal();
  const std::vector<Pole> after = poles(s);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(std::abs(after[i].value - before[i].value), 0, 1e-6);
}

TEST(Zeros, AnAntiresonanceIsWhereTheOtherMassWouldSwingAlone) {
  const std::vector<Complex> zeros = transmission_zeros(two_masses(0));
  ASSERT_EQ(zeros.size(), 2u);
  EXPECT_NEAR(std::abs(zeros[0] - Complex(0, 10)), 0, 1e-9);
}

TEST(Zeros, NonCollocatedUndampedMassesHaveNone) {
  StateSpace s = two_masses(0);
  s.C << 0, 0, 1, 0;
  EXPECT_TRUE(transmission_zeros(s).empty());
}

TEST(Zeros, AWashoutAndALeadHaveTheirs) {
  StateSpace lead;  // (s + 2)/(s + 10)
  lead.A = MatrixXd::Constant(1, 1, -10), lead.B = MatrixXd::Ones(1, 1),
  lead.C = MatrixXd::Constant(1, 1, -8);
  lead.D = MatrixXd::Ones(1, 1);
  EXPECT_NEAR(std::abs(transmission_zeros(lead)[0] - Complex(-2)), 0, 1e-12);
}

TEST(Zeros, OfTwoInputsAndTwoOutputsAreThoseOfTheDeterminant) {
  // G = [1/(s+1), 2/(s+3); 1/(s+1), 1/(s+1)] in minimal form has a zero where 1/(s+1) = 2/(s+3): s = 1.
  StateSpace s;
  s.A = Eigen::Vector3d(-1, -3, -1).asDiagonal();
  s.B.resize(3, 2), s.C.resize(2, 3), s.D = MatrixXd::Zero(2, 2);
  s.B << 1, 0, 0, 1, 0, 1;
  s.C << 1, 2, 0, 1, 0, 1;
  const std::vector<Complex> zeros = transmission_zeros(s);
  ASSERT_EQ(zeros.size(), 1u);
  EXPECT_NEAR(std::abs(zeros[0] - Complex(1)), 0, 1e-10);
}

TEST(Structure, WhatLiesBehindACutWireIsNoPartOfAChannel) {
  StateSpace
      s;  // 0 → 1 → 2, the output reads 1; 2 is unstable, nothing reads it; 3 drives 1, nothing drives it
  s.A = MatrixXd::Zero(4, 4);
  s.A(0, 0) = -1, s.A(1, 0) = 1, s.A(1, 1) = -2, s.A(2, 1) = 1, s.A(2, 2) = 5, s.A(3, 3) = 7, s.A(1, 3) = 1;
  s.B = MatrixXd::Zero(4, 1), s.C = MatrixXd::Zero(1, 4), s.D = MatrixXd::Zero(1, 1);
  s.B(0, 0) = 1, s.C(0, 1) = 1;
  const StateSpace part = connected_part(s);
  EXPECT_EQ(part.states(), 2);
  EXPECT_TRUE(is_stable(part));
  EXPECT_EQ(part.A(1, 0), 1);
}

}  // namespace
}  // namespace loopwright::poles_test
