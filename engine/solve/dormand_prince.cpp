// Dormand & Prince, J. Comp. Appl. Math. 6 (1980); step control, starting step, dense output and stiffness
// test after Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, sections II.4 to II.6, and
// II, section IV.2.
#include "engine/solve/dormand_prince.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace loopwright {

namespace {

// Nodes, stages, the fifth-order solution (which is also the seventh stage), its difference from the embedded
// fourth-order solution, and the weights of the last term of the dense output.
constexpr double c2 = 1.0 / 5, c3 = 3.0 / 10, c4 = 4.0 / 5, c5 = 8.0 / 9;
constexpr double a21 = 1.0 / 5;
constexpr double a31 = 3.0 / 40, a32 = 9.0 / 40;
constexpr double a41 = 44.0 / 45, a42 = -56.0 / 15, a43 = 32.0 / 9;
constexpr double a51 = 19372.0 / 6561, a52 = -25360.0 / 2187, a53 = 64448.0 / 6561, a54 = -212.0 / 729;
constexpr double a61 = 9017.0 / 3168, a62 = -355.0 / 33, a63 = 46732.0 / 5247, a64 = 49.0 / 176,
                 a65 = -5103.0 / 18656;
constexpr double b1 = 35.0 / 384, b3 = 500.0 / 1113, b4 = 125.0 / 192, b5 = -2187.0 / 6784, b6 = 11.0 / 84;
constexpr double e1 = 71.0 / 57600, e3 = -71.0 / 16695, e4 = 71.0 / 1920, e5 = -17253.0 / 339200,
                 e6 = 22.0 / 525, e7 = -1.0 / 40;
constexpr double d1 = -12715105075.0 / 11282082432, d3 = 87487479700.0 / 32700410799,
                 d4 = -10690763975.0 / 1880347072, d5 = 701980252875.0 / 199316789632,
                 d6 = -1453857185.0 / 822651844, d7 = 69997945.0 / 29380423;

constexpr double safety = 0.9, smallest_factor = 0.2, largest_factor = 10.0, retreat_factor = 0.25;
constexpr double stiff_limit = 3.25;  // slightly less than the stability limit on the real axis, 3.3066
constexpr int stiff_check_interval = 16, stiff_steps_to_conclude = 15, calm_steps_to_forget = 6;

/// x^(1/20) to 0.01 % for x > 0: two exact square roots, then Newton's method for the fifth root. Unlike
/// std::pow it is bit-identical for every mathematics library, and so are the steps.
double twentieth_root(double x) {
  constexpr int64_t one = std::bit_cast<int64_t>(1.0);
  const double fourth_root = std::sqrt(std::sqrt(x));
  double root = std::bit_cast<double>(one + (std::bit_cast<int64_t>(fourth_root) - one) / 5);
  for (int i = 0; i < 2; ++i) root = 0.8 * root + 0.2 * fourth_root / (root * root * root * root);
  return root;
}

double square(double x) { return x * x; }

class DormandPrince final : public Stepper {
 public:
  DormandPrince(const SolverOptions& options, const OdeSystem& system)
      : Stepper(options, system),
        initial_step_(options.initial_step),
        maximum_step_(options.maximum_step),
        storage_(7 * states_),
        stage_(states_),
        trial_(states_) {
    double** stage_rates[] = {&k1_, &k2_, &k3_, &k4_, &k5_, &k6_, &k7_};
    for (size_t i = 0; i < 7; ++i) *stage_rates[i] = storage_.data() + i * states_;
  }

  SolverStatus step(double t_stop) override;
  int worst_state() const override;
  bool can_be_archived() const override { return true; }
  void archive(StateArchive& a) override {
    Stepper::archive(a);
    a.members(step_size_, error_root_, rate_, stiff_streak_, calm_streak_);
    for (double* rates : {k1_, k2_, k3_, k4_, k5_, k6_, k7_})
      for (size_t i = 0; i < states_; ++i) a.members(rates[i]);
  }

 private:
  enum class Rate : uint8_t { unknown, in_k1, in_k7 };  ///< where f(t_end, x_end) is stored

  void forget_all() override {
    step_size_ = initial_step_;
    error_root_ = 1.0;
    stiff_streak_ = calm_streak_ = 0;
    rate_ = Rate::unknown;
  }
  void forget_history() override { rate_ = Rate::unknown; }

  bool know_rate();
  double starting_step(double longest);
  bool try_step(double h, double t_new);
  double error_norm(double h) const;
  double scale(size_t i, double a, double b) const {
    return absolute_tolerance_[i] + relative_tolerance_ * std::max(std::fabs(a), std::fabs(b));
  }
  void check_stiffness(double h);
  void interpolate_within(double t, double* x) const override;

  const double initial_step_, maximum_step_;
  double step_size_ = 0.0;   ///< [s] as required by accuracy, not limited by stop times; 0: not known
  double error_root_ = 1.0;  ///< twentieth root of the last accepted error
  double tried_step_ = 0.0;  ///< [s] length of the last trial step
  Rate rate_ = Rate::unknown;
  int stiff_streak_ = 0, calm_streak_ = 0;
  std::vector<double> storage_;
  double *k1_, *k2_, *k3_, *k4_, *k5_, *k6_, *k7_;
  std::vector<double> stage_;  ///< state of the second to last evaluated stage
  std::vector<double> trial_;  ///< end of the trial step
};

SolverStatus DormandPrince::step(double t_stop) {
  if (!know_rate()) return fail(trouble_);
  const double remaining = t_stop - t_end_;
  if (step_size_ == 0.0) step_size_ = starting_step(std::min(remaining, maximum_step_));
  SolverStatus reason = SolverStatus::step_too_small;
  for (double largest_growth = largest_factor;; largest_growth = 1.0) {
    double h = std::min(step_size_, maximum_step_), t_new = t_end_ + h;
    if (remaining <= maximum_step_ && remaining <= 1.01 * step_size_) {
      h = remaining, t_new = t_stop;
    } else if (remaining < 2.0 * h) {  // two halves instead of a whole step and a tiny one
      h = 0.5 * remaining, t_new = t_end_ + h;
    }
    if (step_size_ < remaining && step_size_ < 4.0 * rounding(t_end_, t_new)) return fail(reason);

    tried_step_ = h;
    trouble_ = SolverStatus::non_finite;
    const double error = try_step(h, t_new) ? error_norm(h) : std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(error)) {  // f may not exist at the trial point: approach it in shorter steps
      ++statistics.convergence_failures;
      reason = trouble_;
      step_size_ = retreat_factor * h;
      continue;
    }
    const double root = twentieth_root(std::max(error, 1e-10));
    if (error > 1.0) {
      ++statistics.error_test_failures;
      reason = SolverStatus::step_too_small;
      step_size_ = h * std::max(smallest_factor, safety / square(square(root)));
      continue;
    }
    const double proposal =
        h * std::clamp(safety * error_root_ / (root * root * root), smallest_factor, largest_growth);
    const bool cut_short = h < std::min(step_size_, maximum_step_);
    if (cut_short) {
      step_size_ = std::max(step_size_, proposal);
    } else {
      statistics.smallest_step = std::min(statistics.smallest_step, h);
      step_size_ = proposal;
      error_root_ = std::max(root, 0.63);  // error of 1e-4: an almost exact step does not predict the next
    }
    if (statistics.steps % stiff_check_interval == 0 || stiff_streak_ > 0) check_stiffness(h);
    accept(t_new, trial_);
    rate_ = Rate::in_k7;
    return SolverStatus::stepped;
  }
}

/// Computes f(t_end, x_end) in k1. After an accepted step it is already the last stage.
bool DormandPrince::know_rate() {
  if (rate_ == Rate::in_k7) std::swap(k1_, k7_);
  if (rate_ == Rate::unknown) {
    trouble_ = SolverStatus::non_finite;
    if (!evaluate(t_end_, x_end_.data(), k1_)) return false;
    double zero = 0.0;
    for (size_t i = 0; i < states_; ++i) zero += 0.0 * k1_[i];
    if (zero != 0.0) {
      tried_step_ = 1.0;  // so that worst_state uses k1 only
      for (double* stale : {k2_, k3_, k4_, k5_, k6_, k7_}) std::fill_n(stale, states_, 0.0);
      return false;
    }
  }
  rate_ = Rate::in_k1;
  return true;
}

/// A first step that changes x by about a hundredth of its size and whose fifth-order error is about a
/// hundredth of the tolerance, estimated by one explicit Euler step. At most `longest` [s].
double DormandPrince::starting_step(double longest) {
  if (states_ == 0) return longest;
  const double count = static_cast<double>(states_);
  double size = 0.0, slope = 0.0,
         bend = 0.0;  // squared norms of x, f and the change of f, in units of the tolerance
  for (size_t i = 0; i < states_; ++i) {
    const double unit = scale(i, x_end_[i], 0.0);
    size += square(x_end_[i] / unit) / count;
    slope += square(k1_[i] / unit) / count;
  }
  const double guess = size < 1e-10 || slope < 1e-10 ? 1e-6 : 0.01 * std::sqrt(size / slope);
  const double h = std::fmin(guess, longest);
  for (size_t i = 0; i < states_; ++i) trial_[i] = x_end_[i] + h * k1_[i];
  if (!evaluate(std::fmin(t_end_ + h, t_end_ + longest), trial_.data(), k2_)) return 1e-3 * h;
  for (size_t i = 0; i < states_; ++i) bend += square((k2_[i] - k1_[i]) / scale(i, x_end_[i], 0.0)) / count;
  const double change = std::fmax(std::sqrt(bend) / h, std::sqrt(slope));
  if (!std::isfinite(change)) return 1e-3 * h;
  const double accurate =
      change <= 1e-15 ? std::fmax(1e-6, 1e-3 * h) : square(square(twentieth_root(0.01 / change)));
  return std::fmin(std::fmin(100.0 * h, accurate), longest);
}

/// The stages of a step of length h to t_new, with its end in trial_. Returns false if a block faulted.
bool DormandPrince::try_step(double h, double t_new) {
  const size_t n = states_;
  const double t = t_end_;
  const double* x = x_end_.data();
  const double *k1 = k1_, *k2 = k2_, *k3 = k3_, *k4 = k4_, *k5 = k5_, *k6 = k6_;
  double *y = stage_.data(), *end = trial_.data();
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + h * (a21 * k1[i]);
  if (!evaluate(t + c2 * h, y, k2_)) return false;
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + h * (a31 * k1[i] + a32 * k2[i]);
  if (!evaluate(t + c3 * h, y, k3_)) return false;
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + h * (a41 * k1[i] + a42 * k2[i] + a43 * k3[i]);
  if (!evaluate(t + c4 * h, y, k4_)) return false;
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + h * (a51 * k1[i] + a52 * k2[i] + a53 * k3[i] + a54 * k4[i]);
  if (!evaluate(t + c5 * h, y, k5_)) return false;
  for (size_t i = 0; i < n; ++i) {
    y[i] = x[i] + h * (a61 * k1[i] + a62 * k2[i] + a63 * k3[i] + a64 * k4[i] + a65 * k5[i]);
  }
  if (!evaluate(t_new, y, k6_)) return false;
  for (size_t i = 0; i < n; ++i) {
    end[i] = x[i] + h * (b1 * k1[i] + b3 * k3[i] + b4 * k4[i] + b5 * k5[i] + b6 * k6[i]);
  }
  return evaluate(t_new, end, k7_);
}

/// The root mean square over the states of error / tolerance: acceptable up to 1. Non-finite if any value is
/// non-finite.
double DormandPrince::error_norm(double h) const {
  if (states_ == 0) return 0.0;
  double sum = 0.0, zero = 0.0;
  for (size_t i = 0; i < states_; ++i) {
    const double error =
        h * (e1 * k1_[i] + e3 * k3_[i] + e4 * k4_[i] + e5 * k5_[i] + e6 * k6_[i] + e7 * k7_[i]);
    sum += square(error / scale(i, x_end_[i], trial_[i]));
    zero += 0.0 * trial_[i];  // an infinite end would have an infinite tolerance
  }
  return std::sqrt(sum / static_cast<double>(states_)) + zero;
}

int DormandPrince::worst_state() const {
  if (trouble_ == SolverStatus::block_fault) return -1;
  int worst = -1;
  double largest = 0.0;
  for (size_t i = 0; i < states_; ++i) {
    const double rates = e1 * k1_[i] + e3 * k3_[i] + e4 * k4_[i] + e5 * k5_[i] + e6 * k6_[i] + e7 * k7_[i];
    const double error = std::fabs(tried_step_ * rates) / scale(i, x_end_[i], 0.0);
    if (!std::isfinite(error)) return static_cast<int>(i);
    if (error > largest) largest = error, worst = static_cast<int>(i);
  }
  return worst;
}

/// Two evaluations at the same time give the fastest mode: h|λ| ≈ h |k7 - k6| / |difference of their states|.
/// If this stays at the stability limit, the step is limited by stability and not by accuracy.
void DormandPrince::check_stiffness(double h) {
  double rates = 0.0, states = 0.0;
  for (size_t i = 0; i < states_; ++i) {
    rates += square(k7_[i] - k6_[i]);
    states += square(trial_[i] - stage_[i]);
  }
  if (states > 0.0 && h * std::sqrt(rates / states) > stiff_limit) {
    ++statistics.stiff_steps;
    calm_streak_ = 0;
    if (++stiff_streak_ == stiff_steps_to_conclude && !statistics.stiff) {
      statistics.stiff = true;
      statistics.stiffest_state = worst_state();
    }
  } else if (++calm_streak_ == calm_steps_to_forget) {
    stiff_streak_ = 0;
  }
}

/// Fourth order over the whole step; value and slope are continuous at its ends.
void DormandPrince::interpolate_within(double t, double* x) const {
  const double h = t_end_ - t_begin_, s = (t - t_begin_) / h, r = 1.0 - s;
  for (size_t i = 0; i < states_; ++i) {
    const double difference = x_end_[i] - x_begin_[i];
    const double begin_bend = h * k1_[i] - difference, end_bend = difference - h * k7_[i] - begin_bend;
    const double last =
        h * (d1 * k1_[i] + d3 * k3_[i] + d4 * k4_[i] + d5 * k5_[i] + d6 * k6_[i] + d7 * k7_[i]);
    x[i] = x_begin_[i] + s * (difference + r * (begin_bend + s * (end_bend + r * last)));
  }
}

}  // namespace

std::unique_ptr<Stepper> make_dormand_prince(const SolverOptions& options, const OdeSystem& system) {
  return std::make_unique<DormandPrince>(options, system);
}

}  // namespace loopwright
