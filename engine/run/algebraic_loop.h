/// An algebraic loop in the order of evaluation: finds the tear numbers y with G(y) = y.
#pragma once
#include <cmath>
#include <memory>
#include <vector>
#include "engine/block/kernels.h"
#include "engine/plan/plan.h"
#include "engine/solve/newton.h"

namespace loopwright {

inline constexpr const char *loop_not_solved = "Newton's method did not converge for its algebraic loop",
                            *loop_is_singular =
                                "its algebraic loop is singular: the equations do not determine the signals";

/// Newton's method on y - G(y), starting from the last solution. Lanes are solved one after another, as each
/// needs its own steps.
template <class Real> class AlgebraicLoopSolver {
 public:
  /// `numbers`: those of the arena.
  void build(std::vector<Call<Real>> calls, Real* numbers, const std::vector<Number>& tears, int first_lane) {
    calls_ = std::move(calls);
    first_lane_ = first_lane;
    faults_.resize(size_t(first_lane + width));
    for (Call<Real>& call : calls_) call.report = faults_.data();
    for (Number n : tears) tears_.push_back(numbers + n);
    y_.resize(tears_.size() * width);
    newton_ =
        std::make_unique<NewtonSolver>(NewtonOptions{}, AlgebraicSystem{this, int(tears_.size()), &residual});
  }

  static uint64_t step(const Call<Real>& call) {
    auto& loop = *const_cast<AlgebraicLoopSolver*>(static_cast<const AlgebraicLoopSolver*>(call.block));
    const Unsolved unsolved = loop.solve();
    const auto report = [&](uint64_t lanes, const char* reason) {
      return lanes ? report_fault(call.report, call.index, {lanes << call.first_lane, reason}) : 0;
    };
    return report(unsolved.not_solved, loop_not_solved) | report(unsolved.singular, loop_is_singular);
  }

 private:
  static constexpr int width = lanes_of<Real>;
  /// One bit for each lane.
  struct Unsolved {
    uint64_t not_solved = 0, singular = 0;
  };

  Real& tear(size_t i) { return *tears_[i]; }
  std::span<double> guess() { return {&y_[size_t(lane_) * tears_.size()], tears_.size()}; }
  template <class F> void each_lane(F&& f) {
    for (lane_ = 0; lane_ < width; ++lane_) f();
  }

  /// The lanes without a solution. In the other lanes the tears and all dependent numbers have the solution.
  Unsolved solve() {
    each_lane([&] {
      for (size_t i = 0; i < tears_.size(); ++i) {
        const double last = lane(tear(i), lane_);
        guess()[i] = std::isfinite(last) ? last : 0.0;
      }
    });
    Unsolved unsolved;
    each_lane([&] {
      const NewtonStatus status = newton_->solve(guess()).status;
      uint64_t& lanes = status == NewtonStatus::singular_jacobian ? unsolved.singular : unsolved.not_solved;
      if (status != NewtonStatus::converged) lanes |= uint64_t(1) << lane_;
    });
    each_lane([&] { take(guess().data()); });
    evaluate();
    return unsolved;
  }
  /// Lanes in which a block faulted. A trial step of the search may well lead to a fault.
  uint64_t evaluate() {
    std::fill(faults_.begin(), faults_.end(), FaultReport{});
    uint64_t bad = 0;
    for (const Call<Real>& c : calls_) bad |= c.step(c);
    return bad;
  }
  void take(const double* y) {
    for (size_t i = 0; i < tears_.size(); ++i) set_lane(tear(i), lane_, y[i]);
  }
  static bool residual(void* self, const double* y, double* r) {
    auto& loop = *static_cast<AlgebraicLoopSolver*>(self);
    loop.take(y);
    const uint64_t bad = loop.evaluate();
    for (size_t i = 0; i < loop.tears_.size(); ++i) r[i] = lane(loop.tear(i), loop.lane_) - y[i];
    return !(bad >> (loop.first_lane_ + loop.lane_) & 1);
  }

  std::vector<Call<Real>> calls_;
  std::vector<Real*> tears_;
  std::vector<FaultReport> faults_;  // of all lanes of the run
  std::vector<double> y_;            // of each lane of the arena
  std::unique_ptr<NewtonSolver> newton_;
  int first_lane_ = 0, lane_ = 0;
};

}  // namespace loopwright
