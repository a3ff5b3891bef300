/// A sample of a diagram that is linear but for constants.
#pragma once
#include <array>
#include <functional>
#include <vector>

namespace loopwright::diagnosis {

/// x' = A x + b u + p F + c, of held input u and force F: what the integration of a sample comes to, without
/// computing its stages. Differs from it by rounding alone.
class AffineSample {
 public:
  static constexpr size_t most_states = 8;
  /// The next states of these, which are changed in place.
  using Step = std::function<void(std::vector<double>& states, double input, double force)>;

  /// `states`: where those that a sample changes stand among all, `most_states` at most.
  AffineSample(std::vector<int> states, const Step& step);

  void step(double* all, double input, double force) const {
    std::array<double, most_states> x;
    const size_t n = states_.size();
    for (size_t i = 0; i < n; ++i) x[i] = all[states_[i]];
    const double* of = coefficients_.data();
    for (size_t i = 0; i < n; ++i, of += n + 3) {
      double next = of[n + 2] + of[n] * input + of[n + 1] * force;
      for (size_t j = 0; j < n; ++j) next += of[j] * x[j];
      all[states_[i]] = next;
    }
  }

 private:
  std::vector<int> states_;
  std::vector<double> coefficients_;  ///< for each state: its row of A, b, p, c
};

}  // namespace loopwright::diagnosis
