#include "tools/linearize/quantizer_slope.h"
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

using Values = std::vector<double>;

class Treads {
 public:
  Treads(BlockBench& bench, size_t input) : bench_(bench), input_(input), rest_(bench.inputs()[input]) {}
  double rest() const { return rest_; }

  /// Outputs with the mode determined for this input.
  Values at(double u) {
    bench_.restore();
    bench_.inputs()[input_] = u;
    Values y(bench_.outputs());
    if (!bench_.decide() || !bench_.compute(y)) y.assign(y.size(), std::nan(""));
    return y;
  }
  /// End of the tread that contains `from` on one side (direction 1 or -1): the first number beyond; NaN:
  /// none.
  double end(double from, double direction) {
    const Values here = at(from);
    const double size = std::max(std::abs(rest_), 1.0);
    double inside = 0, outside = 1e-13 * size;
    for (; at(from + direction * outside) == here; inside = outside, outside *= 2)
      if (!(outside <= 1e3 * size)) return std::nan("");
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (at(from + direction * middle) == here ? inside : outside) = middle;
    }
    return from + direction * outside;
  }

 private:
  BlockBench& bench_;
  size_t input_;
  double rest_;
};

bool are_alike(double a, double b) { return std::abs(a - b) <= 0.2 * std::max(std::abs(a), std::abs(b)); }

}  // namespace

Staircase find_staircase(BlockBench& bench, size_t input) {
  Treads treads(bench, input);
  const double rest = treads.rest(), up = treads.end(rest, 1), down = treads.end(rest, -1);
  const double second_up = treads.end(up, 1), second_down = treads.end(down, -1);
  const double width = (second_up - second_down) / 3;
  const bool even = are_alike(second_up - up, width) && are_alike(up - down, width);  // false without an end
  Staircase stairs;
  if (even) {
    const Values above = treads.at(up), here = treads.at(rest), below = treads.at(down);
    bool rises = false, equal = true;
    for (size_t o = 0; o < here.size(); ++o) {
      rises |= above[o] != below[o];
      equal &= above[o] == below[o] || are_alike(above[o] - here[o], here[o] - below[o]);
    }
    if (equal && rises) {
      stairs.width = width;
      for (size_t o = 0; o < here.size(); ++o) stairs.slope.push_back((above[o] - below[o]) / (2 * width));
    }
  }
  bench.restore();
  return stairs;
}

}  // namespace loopwright
