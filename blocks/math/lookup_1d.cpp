/// y = table(u): linear or monotone cubic interpolation of given points
///
/// The cubic pieces are smooth (once differentiable) and do not overshoot the points: slopes by F. N. Fritsch
/// and J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984; at the ends three-point differences, limited as in C.
/// Moler, Numerical Computing with MATLAB, 2004. Outside the breakpoints: the last value, linear
/// extrapolation, or a fault that stops the run.
#include "blocks/math/table.h"

namespace loopwright::blocks {

enum class Interpolation { linear, monotone_cubic };
constexpr auto names_of(Interpolation) { return std::array<std::string_view, 2>{"linear", "monotone_cubic"}; }

struct Lookup1D {
  std::vector<double> breakpoints, values;
  Interpolation interpolation = Interpolation::linear;
  Outside outside = Outside::hold;
  std::vector<double> slopes;  // at the breakpoints
  struct In {
    double u;
  };
  struct Out {
    double y;
  };
  struct Mode {
    int interval;
  };
  struct Crossings {
    double lower, upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Reads a table with one input.",
        parameter(&Lookup1D::breakpoints, "breakpoints", "$u", "Where values are given, rising"),
        parameter(&Lookup1D::values, "values", "$y", "The value at each breakpoint"),
        parameter(&Lookup1D::interpolation, "interpolation", "", "How values are joined").optional(),
        parameter(&Lookup1D::outside, "outside", "", "What happens beyond the first and last breakpoint")
            .optional(),
        input(&In::u, "u", "$u", "Where to read"), output(&Out::y, "y", "$y", "What the table says"),
        crossing(&Crossings::lower, "lower"), crossing(&Crossings::upper, "upper"));
  }
  void check(const Checker& checker) const {
    check_breakpoints(checker, "breakpoints", breakpoints);
    if (values.size() == breakpoints.size()) return;
    auto& p = checker.error("values", "the table needs as many values as breakpoints");
    p.expected = std::to_string(breakpoints.size());
    p.found = std::to_string(values.size());
  }
  void prepare(double) {
    const size_t last = values.size() - 1;
    const auto width = [&](size_t i) { return breakpoints[i + 1] - breakpoints[i]; };
    const auto secant = [&](size_t i) { return (values[i + 1] - values[i]) / width(i); };
    slopes.assign(values.size(), secant(0));
    slopes[last] = secant(last - 1);
    if (interpolation == Interpolation::linear || last == 1) return;
    for (size_t i = 1; i < last; ++i) {
      const double w = 2 * width(i) + width(i - 1), v = width(i) + 2 * width(i - 1);
      slopes[i] = secant(i - 1) * secant(i) <= 0 ? 0.0 : (w + v) / (w / secant(i - 1) + v / secant(i));
    }
    slopes[0] = end_slope(width(0), width(1), secant(0), secant(1));
    slopes[last] = end_slope(width(last - 1), width(last - 2), secant(last - 1), secant(last - 2));
  }
  void decide(const In& in, Mode& mode) const { mode.interval = interval_of(breakpoints, in.u); }
  Fault outputs(const In& in, Out& out) const {
    const double u = std::clamp(in.u, breakpoints.front(), breakpoints.back()), beyond = in.u - u;
    const size_t i = inner_interval(breakpoints, u), j = i + 1;
    const double width = breakpoints[j] - breakpoints[i], s = (u - breakpoints[i]) / width, r = 1 - s;
    if (interpolation == Interpolation::linear)
      out.y = r * values[i] + s * values[j];
    else
      out.y = r * r * ((1 + 2 * s) * values[i] + s * width * slopes[i]) +
              s * s * ((1 + 2 * r) * values[j] - r * width * slopes[j]);
    if (outside == Outside::extrapolate && beyond != 0)
      out.y += beyond * (beyond < 0 ? slopes.front() : slopes.back());
    return fault_if(outside == Outside::fault && beyond != 0, "the input lies outside of the table");
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.lower = above_border(breakpoints, mode.interval, in.u);
    value.upper = below_border(breakpoints, mode.interval, in.u);
  }

 private:
  static double end_slope(double near, double far, double first, double second) {
    const double slope = ((2 * near + far) * first - near * second) / (near + far);
    if (slope * first <= 0) return 0;
    return first * second < 0 && std::abs(slope) > 3 * std::abs(first) ? 3 * first : slope;
  }
};
LOOPWRIGHT_BLOCK(Lookup1D)

}  // namespace loopwright::blocks
