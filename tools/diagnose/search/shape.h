/// The shapes that a missing term may have, as functions of one signal.
#pragma once
#include <array>
#include <functional>
#include <span>
#include <string_view>
#include <vector>
#include "tools/diagnose/predict/input_lines.h"
#include "tools/diagnose/predict/quantity.h"

namespace loopwright::diagnosis {

inline constexpr int most_columns = 33, most_nonlinear = 2;

/// term = Σ coefficient · column(signal; p), p being the shape's own parameters.
struct TermShape {
  enum class Of {
    nothing,  ///< a constant
    signal,   ///< any signal that fits
    own,      ///< the signal at the site itself: a distortion, whose coefficient is one
    past,     ///< a recorded input, which gets to the machine late
  };
  std::string_view name, title;
  /// The same as an expression of "signal", of the coefficients and of its own parameters, by which the shape
  /// is written into a diagram; empty: a block of another kind.
  std::string_view formula;
  Of of = Of::signal;
  int columns = 1;
  double cost = 0;  ///< nats, of its prior
  /// [unit of the site / unit of the signal^power] Its coefficients; those of a function without a name have
  /// the unit of the site.
  std::array<std::string_view, 2> coefficients;
  double power = 0;
  std::function<void(double signal, const double* p, double* column)> evaluate = nullptr;
  /// Names of its own parameters, in the unit of the signal; empty: none.
  std::array<std::string_view, most_nonlinear> nonlinear{};
  std::function<bool(Quantity site, Quantity signal)> fits = nullptr;
  /// Values of its own parameters to begin with, from the largest size and the range of the signal; those of
  /// the past are in samples, and those of a law with a memory in the signal's unit times samples.
  std::function<std::vector<std::array<double, most_nonlinear>>(std::span<const double> signal)> starts =
      nullptr;
  /// Within which its own parameters are fitted; empty: about as large as the signal.
  struct Ranges {
    std::array<double, most_nonlinear> low{}, high{};
  };
  std::function<Ranges(std::span<const double> signal)> ranges = nullptr;
  /// Σ coefficient · column where most columns are zero; null: by `evaluate`.
  std::function<double(double signal, const double* p, const double* coefficient)> value = nullptr;

  /// Of the past: what the machine gets of an input. The input `before` the record is fitted with the time.
  std::function<InputLines(const SignalRecord&, const InputLines& input, double time, double before)> late =
      nullptr;

  /// Of a law with a memory, which is its only column: what it remembers after so many seconds in which the
  /// signal changes evenly.
  std::function<double(double before, double from, double to, double time, const double* p)> remembered =
      nullptr;

  /// Its first own parameter is the width within which it changes its side where the signal is zero.
  bool has_front = false;

  bool has_coefficients() const { return of != Of::own && of != Of::past; }
  int nonlinear_count() const { return int(nonlinear[0] != "") + int(nonlinear[1] != ""); }
};

std::span<const TermShape> named_shapes();
/// Functions without a name: straight lines between 9, 17 and 33 nodes over the range of the signal. The
/// coefficients are the values at the nodes.
std::span<const TermShape> unknown_functions();
bool is_unknown_function(const TermShape& shape);
/// A force that keeps its size at rest, of whatever shape beyond.
bool is_dry_friction(const TermShape& shape);

}  // namespace loopwright::diagnosis
