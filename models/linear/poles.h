/// Poles and zeros of linear systems.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

struct Pole {
  std::complex<double> value;  ///< 1/s, or in the z-plane
  /// The same in the s-plane, ln(z)/T for a sampled system; a pole at z = 0 forgets at once and has none.
  std::complex<double> continuous;
  double frequency = 0;  ///< rad/s, |s|; infinity for z = 0
  double damping = 1;    ///< -Re s / |s|; 1 for s = 0
  /// How much each state takes part: |left · right eigenvector|, element by element, with sum 1
  /// (I. J. Pérez-Arriaga, G. C. Verghese, F. C. Schweppe, IEEE Trans. Power Apparatus and Systems 101,
  /// 1982).
  std::vector<double> participation;

  bool is_stable(double sample_time) const {
    return sample_time > 0 ? std::abs(value) < 1 : value.real() < 0;
  }
};

/// Eigenvalues of A after balancing, slowest first. Delays of the system are not seen.
std::vector<Pole> poles(const StateSpace& system);

/// True if no pole lies on or beyond the boundary of stability.
bool is_stable(const StateSpace& system);

/// The largest |z|, or the largest real part.
double outermost_pole(const StateSpace& system);

/// Transmission zeros: where the system blocks some input from every output, those of the whole system if it
/// has several inputs or outputs. The finite generalised eigenvalues of [A - s, B; C, D], found by reducing
/// the system until its D has full rank (A. Emami-Naeini, P. Van Dooren, Automatica 18, 1982); `tolerance`
/// decides on ranks, relative to the size of the balanced system. A system that blocks everywhere has none.
std::vector<std::complex<double>> transmission_zeros(const StateSpace& system, double tolerance = 1e-11);

/// The same system with states scaled by powers of two so that rows and columns of [A B; C 0] are of like
/// size: metres beside newtons would cost digits.
StateSpace balanced(const StateSpace& system, std::vector<double>* scales = nullptr);

}  // namespace loopwright
