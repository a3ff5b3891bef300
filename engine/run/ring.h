/// A ring of direct feedthrough at its place in the order: the tear numbers y that reproduce themselves, G(y) = y.
#pragma once
#include <cmath>
#include <stdexcept>
#include "engine/block/kernels.h"
#include "engine/plan/plan.h"
#include "engine/solve/newton.h"

namespace loopwright {

template <class Real>
class RingSolver {
 public:
  void build(std::vector<Call<Real>>, Real*, const std::vector<Number>&) {
    throw std::logic_error("rings are solved in scalar runs only");
  }
  static uint64_t step(const Call<Real>&) { return ~uint64_t(0); }
};

/// Newton's method on y - G(y), from the values of the last solution. One register.
template <>
class RingSolver<double> {
 public:
  void build(std::vector<Call<double>> calls, double* numbers, const std::vector<Number>& tears);
  static uint64_t step(const Call<double>& call);

 private:
  static bool residual(void* self, const double* y, double* r);
  std::vector<Call<double>> calls_;
  std::vector<double*> tears_;
  std::vector<double> y_;
  std::unique_ptr<NewtonSolver> newton_;
};

}  // namespace loopwright
