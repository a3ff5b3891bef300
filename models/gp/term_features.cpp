#include "models/gp/term_features.h"
#include <algorithm>
#include <numbers>
#include "models/real/functions.h"

namespace loopwright::gp {

size_t TermFeatures::size(size_t input) const {
  return std::max<size_t>(1, nodes[input].size() + weights[input].size());
}

void correlations(const TermFeatures& term, size_t input, double value, double* out) {
  const Shape& shape = term.along[input];
  if (shape.kind == Shape::Kind::constant) {
    out[0] = 1;
  } else if (shape.kind == Shape::Kind::squared_exponential) {
    const auto& nodes = term.nodes[input];
    const double scale = -0.5 / (shape.length * shape.length);
    for (size_t i = 0; i < nodes.size(); ++i) {
      const double off = value - nodes[i];
      out[i] = exponential(scale * (off * off));
    }
  } else {
    const auto& weights = term.weights[input];
    const double turns = value / shape.period;
    const double angle = 2 * std::numbers::pi * (turns - round_even(turns));
    const double c1 = cosine(angle), s1 = sine(angle);
    double c = c1, s = s1;
    out[0] = weights[0];
    for (size_t i = 1; i + 1 < weights.size(); i += 2) {
      out[i] = weights[i] * c;
      out[i + 1] = weights[i + 1] * s;
      const double next = c * c1 - s * s1;
      s = s * c1 + c * s1;
      c = next;
    }
  }
}

void correlation_slopes(const TermFeatures& term, size_t input, double value, double* out) {
  const Shape& shape = term.along[input];
  correlations(term, input, value, out);
  if (shape.kind == Shape::Kind::constant) {
    out[0] = 0;
  } else if (shape.kind == Shape::Kind::squared_exponential) {
    for (size_t i = 0; i < term.nodes[input].size(); ++i)
      out[i] *= (term.nodes[input][i] - value) / (shape.length * shape.length);
  } else {
    const double rate = 2 * std::numbers::pi / shape.period;
    out[0] = 0;
    for (size_t i = 1; i + 1 < term.weights[input].size(); i += 2) {
      const double harmonic = rate * double((i + 1) / 2), cosine_part = out[i];
      out[i] = -harmonic * out[i + 1];
      out[i + 1] = harmonic * cosine_part;
    }
  }
}

Jet jet_of(const TermFeatures& term, const Point& at) {
  std::array<std::vector<double>, 2> c, slope;
  for (size_t d = 0; d < 2; ++d) {
    c[d].resize(term.size(d)), slope[d].resize(term.size(d));
    correlations(term, d, at[d], c[d].data());
    correlation_slopes(term, d, at[d], slope[d].data());
  }
  Jet sum{};
  for (size_t i = 0, at_beta = 0; i < c[0].size(); ++i)
    for (size_t j = 0; j < c[1].size(); ++j, ++at_beta) {
      const double w = term.variance * term.coefficients[at_beta];
      sum[0] += w * c[0][i] * c[1][j], sum[1] += w * slope[0][i] * c[1][j];
      sum[2] += w * c[0][i] * slope[1][j], sum[3] += w * slope[0][i] * slope[1][j];
    }
  return sum;
}

}  // namespace loopwright::gp
