#include "models/linear/margins.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/linear/frequency_range.h"
#include "models/linear/frequency_response.h"

namespace loopwright {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The zero of f between a and b, where its sign changes.
template <class F> double root(F&& f, double a, double b) {
  const bool rises = f(a) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a + b);
    ((f(middle) < 0) == rises ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

/// The maximum of f between a and b, assumed unimodal.
template <class F> double summit(F&& f, double a, double b) {
  constexpr double golden = 0.6180339887498949;
  double c = b - golden * (b - a), d = a + golden * (b - a);
  for (int i = 0; i < 60; ++i) {
    if (f(c) > f(d))
      b = d, d = c, c = b - golden * (b - a);
    else
      a = c, c = d, d = a + golden * (b - a);
  }
  return 0.5 * (a + b);
}

class MarginSearch {
 public:
  MarginSearch(const StateSpace& loop, int lifted)
      : response_(loop, lifted), frequencies_(loop_frequencies(loop, 3000, lifted)) {}

  void search(Margins& m) {
    for (double frequency : frequencies_) values_.push_back(L(frequency));
    for (size_t i = 1; i < frequencies_.size(); ++i) {
      const double a = frequencies_[i - 1], b = frequencies_[i];
      const Complex before = values_[i - 1], after = values_[i];
      if ((before.imag() < 0) != (after.imag() < 0) && before.real() + after.real() < 0)
        add_real(m, root([&](double f) { return L(f).imag(); }, a, b));
      if ((std::abs(before) < 1) != (std::abs(after) < 1))
        add_crossover(m, root([&](double f) { return std::abs(L(f)) - 1; }, a, b));
      add_sensitivity(m, b);
    }
    if (std::isfinite(response_.nyquist())) add_real(m, response_.nyquist());  // always real there
    refine_peak(m);
  }

 private:
  Complex L(double frequency) const { return response_.at(frequency)(0, 0); }
  double sensitivity(double frequency) const { return 1 / std::abs(1.0 + L(frequency)); }

  void add_real(Margins& m, double frequency) {
    const Complex value = L(frequency);
    if (!(value.real() < 0) || std::abs(value.imag()) > 1e-3 * std::abs(value)) return;
    const double factor = 1 / std::abs(value);
    if (factor > 1 && factor < m.gain) m.gain = factor, m.gain_frequency = frequency;
    if (factor < 1 && factor > m.lower_gain) m.lower_gain = factor, m.lower_gain_frequency = frequency;
  }
  void add_crossover(Margins& m, double frequency) {
    const double above = pi + std::arg(L(frequency));  // 0 … 2π: the remaining phase lag
    const double phase = std::min(above, 2 * pi - above);
    if (phase < m.phase) m.phase = phase, m.phase_frequency = frequency;
    if (above / frequency < m.delay) m.delay = above / frequency, m.delay_frequency = frequency;
  }
  void add_sensitivity(Margins& m, double frequency) {
    const double s = sensitivity(frequency);
    if (s > m.Ms) m.Ms = s, m.Ms_frequency = frequency;
  }
  void refine_peak(Margins& m) {
    const auto at = std::ranges::lower_bound(frequencies_, m.Ms_frequency);
    if (m.Ms_frequency == 0 || at == frequencies_.begin() || at + 1 >= frequencies_.end()) return;
    add_sensitivity(m, summit([&](double f) { return sensitivity(f); }, *(at - 1), *(at + 1)));
  }

  FrequencyResponse response_;
  std::vector<double> frequencies_;
  std::vector<Complex> values_;
};

}  // namespace

StateSpace closed_loop(const StateSpace& loop_gain) {
  const StateSpace loop = with_approximate_delays(loop_gain, 6);
  const Eigen::MatrixXd share = (Eigen::MatrixXd::Identity(loop.D.rows(), loop.D.cols()) + loop.D).inverse();
  return {
      loop.A - loop.B * share * loop.C, loop.B * share, share * loop.C, share * loop.D, loop.sample_time, {}};
}

Margins margins(const StateSpace& loop_gain, int lifted) {
  Margins m;
  Modes modes = modes_between(closed_loop(loop_gain));
  m.stability = modes.stability, m.largest_pole = modes.outermost, m.outside = std::move(modes.outside);
  MarginSearch(loop_gain, lifted).search(m);
  return m;
}

}  // namespace loopwright
