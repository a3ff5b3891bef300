/// Kernels and samples that the tests of Gaussian processes share.
#pragma once
#include <cmath>
#include <numbers>
#include <random>
#include "models/gp/kernel.h"

namespace loopwright::gp {

inline constexpr double pitch = 0.0225;  // m

inline Shape periodic(double length, double period = pitch) {
  return {Shape::Kind::periodic, length, period};
}
inline Shape smooth(double length) { return {Shape::Kind::squared_exponential, length, 0}; }

/// PE(x) + SE(v), SE(x) + SE(v), PE(x)·SE(v) + SE(v), at realistic hyper-parameters of a fit.
inline Kernel additive() {
  return {{Term{0.64, {periodic(2.1), Shape{}}}, Term{0.14, {Shape{}, smooth(0.21)}}}, 0.1};
}
inline Kernel double_smooth() {
  return {{Term{0.64, {smooth(0.0045), Shape{}}}, Term{0.14, {Shape{}, smooth(0.21)}}}, 0.1};
}
inline Kernel product() {
  return {{Term{0.64, {periodic(1.5), smooth(0.3)}}, Term{0.14, {Shape{}, smooth(0.21)}}}, 0.1};
}
inline Kernel smooth_product_and_constant() {
  return {{Term{0.5, {smooth(0.1), smooth(0.3)}}, Term{0.3, {Shape{}, Shape{}}}}, 0.2};
}

enum class Velocities { few, continuous };

/// Cogging whose amplitude decreases with speed, drag, and noise. Labels have zero mean.
inline Samples disturbance(int count, Velocities velocities, double noise = 0.1, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  Samples samples;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double v = velocities == Velocities::few ? 0.05 * (1 + int(10 * uniform(random)))
                                                   : 0.05 + 0.45 * uniform(random);
    const double x = 0.1 + 0.225 * uniform(random), angle = 2 * std::numbers::pi * x / pitch;
    samples.inputs.push_back({x, v});
    samples.labels.push_back(0.76 * (1 - 0.6 * v) * std::sin(angle + 0.4) + 0.2 * std::sin(2 * angle + 0.5) -
                             0.3 * v * v + noise * normal(random));
    sum += samples.labels.back();
  }
  for (double& label : samples.labels) label -= sum / count;
  return samples;
}

}  // namespace loopwright::gp
