#include "tools/diagnose/predict/linear_load.h"

namespace loopwright::diagnosis {
namespace {

Eigen::VectorXd longer(const Eigen::VectorXd& vector, Eigen::Index by) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(vector.size() + by);
  result.head(vector.size()) = vector;
  return result;
}

}  // namespace

LinearAxis with_load(LinearAxis axis, const SampleMap& load) {
  if (axis.position < 0 || axis.velocity < 0) return axis;
  const Eigen::Index before = axis.A.rows(), own = Eigen::Index(load.states), all = before + own;
  for (Eigen::VectorXd* vector : {&axis.push, &axis.input_push, &axis.noise_push, &axis.slope_share})
    *vector = longer(*vector, own);
  axis.load_force = longer(axis.load_force.size() > 0 ? axis.load_force : Eigen::VectorXd::Zero(before), own);
  axis.C.conservativeResizeLike(Eigen::MatrixXd::Zero(axis.C.rows(), all));
  axis.A.conservativeResizeLike(Eigen::MatrixXd::Zero(all, all));
  Eigen::VectorXd force = Eigen::VectorXd::Zero(all);
  const auto follows = [&](Eigen::Index state, const std::vector<double>& column) {
    for (Eigen::Index i = 0; i < own; ++i) axis.A(before + i, state) = column[size_t(i)];
    force[state] = column[load.states];
  };
  for (Eigen::Index i = 0; i < own; ++i) follows(before + i, load.columns[size_t(i)]);
  follows(axis.position, load.columns[load.states + GivenSignals::position]);
  follows(axis.velocity, load.columns[load.states + GivenSignals::velocity]);
  axis.A.noalias() -= axis.push * force.transpose();
  axis.load_force += force, axis.load_states += own;
  return axis;
}

LoadDeviation::LoadDeviation(const LinearAxis& axis, const Path* along)
    : axis_(axis),
      along_(along),
      own_(along ? axis.load_states : 0),
      onward_(axis.A.bottomRows(own_)),
      state_(Eigen::VectorXd::Zero(axis.A.rows())),
      next_(own_) {}

void LoadDeviation::correct(const double* gains, double error) {
  const Eigen::Index n = state_.size();
  for (Eigen::Index i = n - own_; i < n; ++i) state_[i] += error * gains[i];
}

double LoadDeviation::force(size_t row, double position, double velocity) {
  if (own_ == 0) return 0;
  state_[axis_.position] = position - along_->position[row];
  state_[axis_.velocity] = velocity - along_->velocity[row];
  const double consumed = axis_.load_force.dot(state_);
  next_.noalias() = onward_ * state_;
  state_.tail(own_) = next_;
  return consumed;
}

}  // namespace loopwright::diagnosis
