#include "models/linear/frequency_response.h"
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include "models/linear/decompositions.h"
#include "models/linear/poles.h"

namespace loopwright {

using Eigen::Index;
using Eigen::MatrixXcd;
using Complex = std::complex<double>;

FrequencyResponse::FrequencyResponse(const StateSpace& system, int lifted)
    : system_(balanced(system)), lifted_(lifted) {
  if (system.states() == 0) return;
  const auto [T, U] = triangularised(system_.A);
  T_ = T, B_ = U.adjoint() * system_.B, C_ = system_.C * U;
}

double FrequencyResponse::nyquist() const {
  return system_.sample_time > 0 ? std::numbers::pi * lifted_ / system_.sample_time
                                 : std::numeric_limits<double>::infinity();
}

MatrixXcd FrequencyResponse::transfer(Complex point) const {
  if (system_.states() == 0) return system_.D.cast<Complex>();
  MatrixXcd pencil = -T_;
  pencil.diagonal().array() += point;
  return C_ * pencil.triangularView<Eigen::Upper>().solve(B_) + system_.D;
}

MatrixXcd FrequencyResponse::at(double frequency) const {
  const Complex turn(0, frequency * system_.sample_time);
  const MatrixXcd all = transfer(system_.sample_time > 0 ? std::exp(turn) : Complex(0, frequency));
  const Index inputs = system_.inputs(), outputs = system_.outputs();
  if (lifted_ > 1) {
    const Index m = inputs / lifted_, p = outputs / lifted_;
    MatrixXcd share = MatrixXcd::Zero(p, m);
    for (int out = 0; out < lifted_; ++out)
      for (int in = 0; in < lifted_; ++in)
        share += std::exp(turn * double(in - out) / double(lifted_)) * all.block(out * p, in * m, p, m);
    return share / double(lifted_);
  }
  const Index delays = Index(system_.delays.size());
  if (delays == 0) return all;
  MatrixXcd lag = MatrixXcd::Zero(delays, delays);
  for (Index i = 0; i < delays; ++i) lag(i, i) = std::exp(Complex(0, -frequency * system_.delays[size_t(i)]));
  const MatrixXcd around = MatrixXcd::Identity(delays, delays) - lag * all.bottomRightCorner(delays, delays);
  return all.topLeftCorner(outputs, inputs) +
         all.topRightCorner(outputs, delays) *
             around.partialPivLu().solve(lag * all.bottomLeftCorner(delays, inputs));
}

}  // namespace loopwright
