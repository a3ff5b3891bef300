#include "models/gp/statistics.h"
#include <Eigen/Core>
#include <algorithm>
#include <numeric>

namespace loopwright::gp {
namespace {

using Eigen::MatrixXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr const char* input_names[] = {"position", "velocity"};

/// The distinct values along an input, ascending; nothing if there are more than `most_levels`.
std::vector<double> distinct(const Samples& samples, size_t input) {
  std::vector<double> values;
  double last = samples.inputs[0][input] + 1;
  for (const Point& point : samples.inputs) {
    if (point[input] == last) continue;
    last = point[input];
    const auto at = std::ranges::lower_bound(values, last);
    if (at != values.end() && *at == last) continue;
    if (values.size() == most_levels) return {};
    values.insert(at, last);
  }
  return values;
}

/// A basis that serves every term along an input.
std::optional<Basis> choose(const Kernel& kernel, size_t input, double shortest, const Samples& samples,
                            std::string& why_not) {
  Basis basis;
  const auto [low, high] = std::ranges::minmax(samples.inputs, {}, [&](const Point& p) { return p[input]; });
  basis.low = low[input], basis.high = high[input];
  const Shape* first = nullptr;
  for (const Term& term : kernel.terms) {
    const Shape& shape = term.along[input];
    if (shape.kind == Shape::Kind::constant) continue;
    if (first && (first->kind != shape.kind || first->period != shape.period)) {
      why_not = std::string("the terms see the ") + input_names[input] + " in different ways";
      return {};
    }
    first = &shape;
  }
  if (!first) return basis;
  if (first->kind == Shape::Kind::periodic) {
    basis.kind = Basis::Kind::fourier;
    basis.period = first->period;
  } else if (basis.levels = distinct(samples, input); !basis.levels.empty()) {
    basis.kind = Basis::Kind::levels;
    basis.size = int(basis.levels.size());
    return basis;
  } else {
    basis.kind = Basis::Kind::chebyshev;
  }
  basis.size = std::min(size_for(basis, shortest), most_functions - 1);
  return basis;
}

/// The number of rows or columns of moments that the features themselves need (for levels including the
/// constant).
int feature_count(const Basis& basis) {
  return basis.kind == Basis::Kind::levels ? basis.size + 1 : basis.size;
}

/// Adds up in parts. Where the velocity has levels, each part has samples of one level.
class Summation {
 public:
  Summation(Statistics& to, const Samples& samples)
      : to_(to), samples_(samples), by_level_(to.bases[1].kind == Basis::Kind::levels) {
    sums_ = Matrix::Zero(moment_count(to.bases[0]), moment_count(to.bases[1]));
    label_sums_ = Matrix::Zero(feature_count(to.bases[0]), feature_count(to.bases[1]));
  }
  void run() {
    std::vector<size_t> order(samples_.inputs.size());
    std::iota(order.begin(), order.end(), size_t(0));
    if (by_level_) std::ranges::stable_sort(order, {}, [&](size_t i) { return samples_.inputs[i][1]; });
    for (size_t begin = 0; begin < order.size();) {
      size_t end = std::min(begin + part, order.size());
      if (by_level_)
        for (size_t i = begin; i < end; ++i)
          if (samples_.inputs[order[i]][1] != samples_.inputs[order[begin]][1]) end = i;
      add({order.data() + begin, end - begin});
      begin = end;
    }
    if (by_level_) {
      sums_.rightCols<1>() = sums_.leftCols(sums_.cols() - 1).rowwise().sum();
      label_sums_.rightCols<1>() = label_sums_.leftCols(label_sums_.cols() - 1).rowwise().sum();
    }
    to_.moments.assign(sums_.data(), sums_.data() + sums_.size());
    to_.label_moments.assign(label_sums_.data(), label_sums_.data() + label_sums_.size());
  }

 private:
  static constexpr size_t part = 256;

  void add(std::span<const size_t> chosen) {
    const auto n = Eigen::Index(chosen.size());
    std::array<std::vector<double>, 2> inputs;
    Eigen::VectorXd labels(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (size_t d = 0; d < 2; ++d) inputs[d].push_back(samples_.inputs[chosen[size_t(i)]][d]);
      labels(i) = samples_.labels[chosen[size_t(i)]];
    }
    to_.label_square += labels.squaredNorm();
    along_position_.resize(n, sums_.rows());
    moment_functions(to_.bases[0], inputs[0], int(sums_.rows()), along_position_.data());
    const auto rows = label_sums_.rows(), columns = label_sums_.cols();
    if (by_level_) {
      const auto& levels = to_.bases[1].levels;
      const auto level = std::ranges::lower_bound(levels, inputs[1][0]) - levels.begin();
      sums_.col(level) += along_position_.colwise().sum().transpose();
      label_sums_.col(level).noalias() += along_position_.leftCols(rows).transpose() * labels;
      return;
    }
    along_velocity_.resize(n, sums_.cols());
    moment_functions(to_.bases[1], inputs[1], int(sums_.cols()), along_velocity_.data());
    sums_.noalias() += along_position_.transpose() * along_velocity_;
    label_sums_.noalias() += along_position_.leftCols(rows).transpose() *
                             (labels.asDiagonal() * along_velocity_.leftCols(columns)).eval();
  }

  Statistics& to_;
  const Samples& samples_;
  bool by_level_;
  Matrix sums_, label_sums_;
  MatrixXd along_position_, along_velocity_;
};

}  // namespace

double resolved_length(const Basis& basis) {
  if (basis.kind != Basis::Kind::chebyshev && basis.kind != Basis::Kind::fourier) return 0;
  if (basis.kind == Basis::Kind::chebyshev)
    return 8.3 * 0.5 * (basis.high - basis.low) / std::max(basis.size - 14, 1);
  double low = 1e-3, high = 1e3;  // size_for decreases with the length: bisection
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (size_for(basis, middle) > basis.size ? low : high) = middle;
  }
  return high;
}

Statistics cut(const Statistics& statistics, const Kernel& kernel) {
  Statistics result = statistics;
  for (size_t d = 0; d < 2; ++d) {
    result.bases[d].size = statistics.bases[d].kind == Basis::Kind::levels ? statistics.bases[d].size : 1;
    for (const Term& term : kernel.terms)
      if (term.along[d].kind != Shape::Kind::constant)
        result.bases[d].size =
            std::max(result.bases[d].size, cut(statistics.bases[d], term.along[d].length).size);
  }
  const auto corner = [](std::vector<double>& values, int columns, int kept_rows, int kept_columns) {
    const Eigen::Map<const Matrix> all(values.data(), Eigen::Index(values.size()) / columns, columns);
    const Matrix kept = all.topLeftCorner(kept_rows, kept_columns);
    values.assign(kept.data(), kept.data() + kept.size());
  };
  corner(result.moments, moment_count(statistics.bases[1]), moment_count(result.bases[0]),
         moment_count(result.bases[1]));
  corner(result.label_moments, feature_count(statistics.bases[1]), feature_count(result.bases[0]),
         feature_count(result.bases[1]));
  return result;
}

std::optional<Statistics> summarise(const Kernel& kernel, const std::array<double, 2>& shortest,
                                    const Samples& samples, std::string& why_not) {
  Statistics result;
  result.count = samples.inputs.size();
  if (result.count == 0) {
    why_not = "there are no samples";
    return {};
  }
  for (size_t d = 0; d < 2; ++d) {
    const auto basis = choose(kernel, d, shortest[d], samples, why_not);
    if (!basis) return {};
    result.bases[d] = *basis;
  }
  size_t functions = 0;
  for (const Term& term : kernel.terms) {
    size_t of_term = 1;
    for (size_t d = 0; d < 2; ++d)
      if (term.along[d].kind != Shape::Kind::constant)
        of_term *= size_t(cut(result.bases[d], term.along[d].length).size);
    functions += of_term;
  }
  if (functions > 2 * size_t(most_functions)) {
    why_not = "the kernel needs " + std::to_string(functions) + " features";
    return {};
  }
  Summation(result, samples).run();
  return result;
}

}  // namespace loopwright::gp
