#include "models/gp/table.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include "models/real/double_functions.h"

namespace loopwright::gp {
namespace {

constexpr int most_cells_alone = 1 << 16, most_cells_of_pair = 1 << 9;

bool sees(const Term& term, size_t input) { return term.along[input].kind != Shape::Kind::constant; }

}  // namespace

bool MeanTable::Axis::find(double value, int& cell, double& place) const {
  double at = (value - low) * per_step;
  if (wraps) {
    const double turns = value * (per_step / cells);
    at = (turns - std::floor(turns)) * cells;
  } else if (!(at >= 0 && at <= cells)) {
    return false;
  }
  cell = whole_between(at, 0, cells - 1);  // the first cell for NaN; `place` stays NaN
  place = at - cell;
  return true;
}

double MeanTable::TermTable::along_one(const Point& at) const {
  const size_t input = axis[0].is_seen ? 0 : 1;
  int cell;
  double s;
  if (!axis[input].find(at[input], cell, s)) return 0;
  const auto& c = pieces[size_t(cell)];
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

namespace {
/// Weights of f(0), f(1), h f'(0), h f'(1) at position s of a cubic Hermite piece.
std::array<double, 4> hermite(double s) {
  const double t = 1 - s;
  return {t * t * (1 + 2 * s), s * s * (1 + 2 * t), t * t * s, -s * s * t};
}
}  // namespace

double MeanTable::TermTable::along_both(const Point& at) const {
  int i, j;
  double s, t;
  if (!axis[0].find(at[0], i, s) || !axis[1].find(at[1], j, t)) return 0;
  const auto x = hermite(s), v = hermite(t);
  double sum = 0;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const Jet& node = nodes[size_t(j + b) * size_t(axis[0].cells + 1) + size_t(i + a)];
      sum += v[size_t(b)] * (x[size_t(a)] * node[0] + x[size_t(a) + 2] * node[1]) +
             v[size_t(b) + 2] * (x[size_t(a)] * node[2] + x[size_t(a) + 2] * node[3]);
    }
  return sum;
}

MeanTable::TermTable MeanTable::tabulate(const Posterior& posterior, size_t index, double tolerance) {
  const Term& term = posterior.terms()[index];
  const double norm = posterior.term_norm(index);
  const double reach = term.deviation * term.deviation * posterior.weight_sum();  // |f| where c = 1
  const bool is_pair = sees(term, 0) && sees(term, 1);
  TermTable table;
  for (size_t d = 0; d < 2; ++d) {
    if (!sees(term, d)) continue;
    const Shape& shape = term.along[d];
    Axis& axis = table.axis[d];
    axis.is_seen = true;
    axis.wraps = shape.kind == Shape::Kind::periodic;
    if (axis.wraps) {
      axis.high = shape.period;
    } else {
      const double tail = std::min(1.0, 0.1 * tolerance / reach);
      const double margin = shape.length * std::sqrt(-2 * natural_logarithm(tail));
      axis.low = posterior.trained()[d].low - margin;
      axis.high = posterior.trained()[d].high + margin;
      bound_ += tail * reach;
    }
    // Half the tolerance for the interpolation; the two axes of a pair share it.
    const double curvature = norm * derivative_bound(shape, 4) * (is_pair ? 2 : 1);
    const double step = any_power(384 * 0.5 * tolerance / std::max(curvature, 1e-300), 0.25);
    const double cells = std::ceil((axis.high - axis.low) / step);
    axis.cells = whole_between(cells, 1, is_pair ? most_cells_of_pair : most_cells_alone);
    axis.step = (axis.high - axis.low) / axis.cells;
    axis.per_step = 1 / axis.step;
  }
  const auto error = [&](size_t d, double m4) { return any_power(table.axis[d].step, 4) / 384 * m4; };
  const auto derivative = [&](int a, int b) {
    return norm * derivative_bound(term.along[0], a) * derivative_bound(term.along[1], b);
  };
  const auto node = [&](const Axis& axis, int i) {
    return i == axis.cells ? axis.high : axis.low + i * axis.step;
  };
  if (is_pair) {
    // |f - I_x I_v f| ≤ |f - I_x f| + |I_x (f - I_v f)|, and |I_x g| ≤ max|g| + h_x/4 max|g_x|
    bound_ +=
        error(0, derivative(4, 0)) + error(1, derivative(0, 4) + table.axis[0].step / 4 * derivative(1, 4));
    for (int j = 0; j <= table.axis[1].cells; ++j)
      for (int i = 0; i <= table.axis[0].cells; ++i) {
        Jet jet = posterior.term(index, {node(table.axis[0], i), node(table.axis[1], j)});
        jet[1] *= table.axis[0].step, jet[2] *= table.axis[1].step;
        jet[3] *= table.axis[0].step * table.axis[1].step;
        table.nodes.push_back(jet);
      }
    return table;
  }
  const size_t d = sees(term, 0) ? 0 : 1;
  const Axis& axis = table.axis[d];
  bound_ += error(d, d == 0 ? derivative(4, 0) : derivative(0, 4));
  Jet left{};
  for (int i = 0; i <= axis.cells; ++i) {
    Point at{};
    at[d] = node(axis, i);
    Jet right = posterior.term(index, at);
    right[1] *= axis.step, right[2] *= axis.step;
    if (i > 0) {
      const double slope = left[1 + d], end_slope = right[1 + d], rise = right[0] - left[0];
      table.pieces.push_back(
          {left[0], slope, 3 * rise - 2 * slope - end_slope, slope + end_slope - 2 * rise});
    }
    left = right;
  }
  return table;
}

MeanTable::MeanTable(const Posterior& posterior, double tolerance) : constant_(posterior.label_mean()) {
  double prior = 0, size = std::abs(constant_);
  for (const Term& term : posterior.terms()) prior += term.deviation * term.deviation;
  if (tolerance <= 0) tolerance = 1e-6 * std::sqrt(prior);
  const double share = tolerance / double(std::max<size_t>(1, posterior.terms().size()));
  for (size_t t = 0; t < posterior.terms().size(); ++t) {
    const Term& term = posterior.terms()[t];
    size += posterior.term_norm(t);
    if (sees(term, 0) || sees(term, 1))
      tables_.push_back(tabulate(posterior, t, share));
    else
      constant_ += posterior.term(t, {0, 0})[0];
  }
  bound_ += 1e-10 * size;  // rounding, mainly from sums of large coefficients of both signs
}

size_t MeanTable::bytes() const {
  size_t sum = 0;
  for (const TermTable& t : tables_)
    sum += t.nodes.size() * sizeof(Jet) + t.pieces.size() * sizeof(t.pieces[0]);
  return sum;
}

SlopeBounds slope_bounds(const Posterior& posterior) {
  // Each term separately, over its period or interval. The sum over terms is an upper bound. It is tight, as
  // terms of one structure depend on one input each.
  SlopeBounds total;
  total.mean = std::abs(posterior.label_mean());
  for (size_t t = 0; t < posterior.terms().size(); ++t) {
    const Term& term = posterior.terms()[t];
    std::array<int, 2> cells{1, 1};
    std::array<Range, 2> range = posterior.trained();
    for (size_t d = 0; d < 2; ++d) {
      if (!sees(term, d)) continue;
      const Shape& shape = term.along[d];
      if (shape.kind == Shape::Kind::periodic) range[d] = {0, shape.period};
      if (d == 0 && shape.kind == Shape::Kind::squared_exponential)
        range[d] = {range[d].low - 6 * shape.length, range[d].high + 6 * shape.length};
      const double scale =
          shape.kind == Shape::Kind::periodic ? shape.period * shape.length / 7 : shape.length;
      cells[d] =
          whole_between(20 * (range[d].high - range[d].low) / scale, 20, sees(term, 1 - d) ? 300 : 100'000);
    }
    SlopeBounds seen;
    for (int i = 0; i <= cells[0]; ++i)
      for (int j = 0; j <= cells[1]; ++j) {
        const Jet jet = posterior.term(t, {range[0].low + (range[0].high - range[0].low) * i / cells[0],
                                           range[1].low + (range[1].high - range[1].low) * j / cells[1]});
        seen.mean = std::max(seen.mean, std::abs(jet[0]));
        seen.by_position = std::max(seen.by_position, std::abs(jet[1]));
        seen.by_velocity = std::max(seen.by_velocity, std::abs(jet[2]));
      }
    const double norm = posterior.term_norm(t);
    const auto beyond = [&](int a, int b) {  // largest change of ∂ᵃ∂ᵇf from a point to its nearest node
      const double by_x = derivative_bound(term.along[0], a + 1) * derivative_bound(term.along[1], b);
      const double by_v = derivative_bound(term.along[0], a) * derivative_bound(term.along[1], b + 1);
      return 0.5 * norm *
             (by_x * (range[0].high - range[0].low) / cells[0] +
              by_v * (range[1].high - range[1].low) / cells[1]);
    };
    total.mean += seen.mean + beyond(0, 0);
    if (sees(term, 0)) total.by_position += seen.by_position + beyond(1, 0);
    if (sees(term, 1)) total.by_velocity += seen.by_velocity + beyond(0, 1);
  }
  return total;
}

}  // namespace loopwright::gp
