/// What a sample makes of small changes of its first states and of what is added at sites.
///
/// Each step of Runge and Kutta is linearized in its middle: with F = ∂f/∂x and B = ∂f/∂u there, a change
/// goes through the step as it would if the system were linear,
///   X ← X + h/6 (K₁ + 2 K₂ + 2 K₃ + K₄),   K₁ = F X + B u(0),   K₂ = F (X + h/2 K₁) + B u(h/2),   …
/// For linear systems this is the derivative of the sample but for rounding, at a quarter of the evaluations
/// that differences of whole samples need.
#pragma once
#include <Eigen/Dense>
#include <span>
#include <vector>

namespace loopwright::diagnosis {

class FlowSlopes {
 public:
  /// For differences: what the states and what is added at these sites are changed by. Ramps are asked for.
  void prepare(std::span<const double> states, std::vector<int> sites, std::vector<double> at_sites,
               bool with_ramps);
  std::span<const double> changes_of_states() const { return state_changes_; }
  const std::vector<int>& sites() const { return sites_; }
  double change_at_site(size_t index) const { return site_changes_[index]; }

  /// A sample begins.
  void begin();
  /// Steps are not smooth enough to be linearized in their middle: the sample is left to others.
  void give_up() { is_known_ = false; }
  bool is_known() const { return is_known_; }
  /// Of the right-hand side in the middle of a step, to be set before the step is added.
  auto by_state(size_t state) { return F_.col(Eigen::Index(state)); }
  auto by_site(size_t index) { return B_.col(Eigen::Index(index)); }
  /// A step of this length in s, from a part of the sample to another one. One that is longer than the method
  /// is stable to, or not finite, gives up.
  void add_step(double length, double from, double to);

  /// Of the last states by the first ones, by what is held at a site, and by what rises there from -1 to 1.
  const Eigen::MatrixXd& by_states() const { return A_; }
  auto by_held(size_t index) const { return held_.col(Eigen::Index(index)); }
  auto by_ramp(size_t index) const { return ramp_.col(Eigen::Index(index)); }

 private:
  /// By how much a step changes the states at most, in units of what they are changed by: the norm of h F.
  double size_of_step(double length) const;
  template <int N> void add_step_of(double length, double from, double to);

  std::vector<double> state_changes_, site_changes_;
  std::vector<int> sites_;
  Eigen::MatrixXd F_, B_, A_, held_, ramp_;
  bool has_ramps_ = false, is_known_ = false, is_first_ = false;
};

}  // namespace loopwright::diagnosis
