#include "tools/diagnose/predict/flow_slopes.h"
#include <utility>

namespace loopwright::diagnosis {

void FlowSlopes::change(std::span<const double> states, std::vector<int> sites,
                        std::vector<double> at_sites) {
  state_changes_.assign(states.begin(), states.end());
  sites_ = std::move(sites), site_changes_ = std::move(at_sites);
  const auto n = Eigen::Index(state_changes_.size()), count = Eigen::Index(sites_.size());
  F_.resize(n, n), A_.resize(n, n), B_.resize(n, count), held_.resize(n, count), ramp_.resize(n, count);
}

void FlowSlopes::begin() {
  A_.setIdentity(), held_.setZero(), ramp_.setZero();
  is_known_ = true;
}

void FlowSlopes::add_step(double length, double from, double to) {
  advance(A_, length, false, {});
  advance(held_, length, true, {1, 1, 1});
  advance(ramp_, length, true, {2 * from - 1, from + to - 1, 2 * to - 1});
  if (!A_.allFinite() || !held_.allFinite() || !ramp_.allFinite()) give_up();
}

void FlowSlopes::advance(Eigen::MatrixXd& X, double length, bool is_driven, const std::array<double, 3>& u) {
  constexpr double shares[] = {0, 0.5, 0.5, 1}, weights[] = {1, 2, 2, 1};
  constexpr size_t inputs[] = {0, 1, 1, 2};
  sum_ = X;
  for (size_t stage = 0; stage < 4; ++stage) {
    moved_ = X;
    if (stage > 0) moved_ += (shares[stage] * length) * slope_;
    slope_ = F_.lazyProduct(moved_);
    if (is_driven) slope_ += u[inputs[stage]] * B_;
    sum_ += (weights[stage] * length / 6) * slope_;
  }
  X.swap(sum_);
}

}  // namespace loopwright::diagnosis
