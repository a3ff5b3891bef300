/// Poles and zeros of linear systems.
#pragma once
#include <string_view>
#include "models/linear/state_space.h"

namespace loopwright {

struct Pole {
  std::complex<double> value;  ///< 1/s, or in the z-plane
  /// The same in the s-plane, ln(z)/T for a sampled system; a pole at z = 0 has none, as it decays in one
  /// sample.
  std::complex<double> continuous;
  double frequency = 0;  ///< rad/s, |s|; infinity for z = 0
  double damping = 1;    ///< -Re s / |s|; 1 for s = 0
  /// Participation of each state: |left · right eigenvector|, element by element, normalized to sum 1 (I. J.
  /// Pérez-Arriaga, G. C. Verghese, F. C. Schweppe, IEEE Trans. Power Apparatus and Systems 101, 1982).
  std::vector<double> participation;

  bool is_stable(double sample_time) const {
    return sample_time > 0 ? std::abs(value) < 1 : value.real() < 0;
  }
};

/// Eigenvalues of integrators are found to about the square root of the rounding error. Within that distance
/// a pole is on the boundary of stability: it neither decays nor grows.
enum class Stability { stable, boundary, unstable };

/// "stable", "boundary", "unstable"
std::string_view name_of(Stability stability);
/// `fastest`: the largest |pole| of the system, the scale of rounding errors in a continuous one.
Stability stability_of(const Pole& pole, double sample_time, double fastest);
double fastest_of(const std::vector<Pole>& poles);

/// Eigenvalues of A after balancing, slowest first. Delays of the system are ignored.
std::vector<Pole> poles(const StateSpace& system);

/// True if no pole lies on or beyond the boundary of stability.
bool is_stable(const StateSpace& system);

/// The largest |z|, or the largest real part.
double outermost_pole(const StateSpace& system);

/// Transmission zeros: frequencies at which the system blocks some input from every output; for several
/// inputs or outputs, the zeros of the whole system. They are the finite generalized eigenvalues of [A - s,
/// B; C, D], found by reducing the system until its D has full rank (A. Emami-Naeini, P. Van Dooren,
/// Automatica 18, 1982). `tolerance` decides ranks, relative to the norm of the balanced system. A system
/// that blocks at every frequency has none.
std::vector<std::complex<double>> transmission_zeros(const StateSpace& system, double tolerance = 1e-11);

/// The same system with states scaled by powers of two such that rows and columns of [A B; C 0] have similar
/// size. States of very different size, such as meters beside newtons, would cost accuracy.
StateSpace balanced(const StateSpace& system, std::vector<double>* scales = nullptr);

}  // namespace loopwright
