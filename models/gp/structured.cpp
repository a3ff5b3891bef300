#include "models/gp/structured.h"
#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include "models/real/functions.h"

namespace loopwright::gp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The part of a basis that one term uses along one input.
Basis basis_of(const Statistics& statistics, const Shape& shape, size_t input) {
  if (shape.kind == Shape::Kind::constant) return {};
  return cut(statistics.bases[input], shape.length);
}

/// L with L Lᵀ = K to rounding, with as few columns as necessary (pivoted Cholesky).
MatrixXd low_rank_root(MatrixXd k) {
  const Index n = k.rows();
  MatrixXd root = MatrixXd::Zero(n, n);
  VectorXd left = k.diagonal();
  for (Index rank = 0; rank < n; ++rank) {
    Index pivot;
    if (left.maxCoeff(&pivot) < 4e-16) return root.leftCols(rank);
    VectorXd column = k.col(pivot);
    column.noalias() -= root.leftCols(rank) * root.row(pivot).head(rank).transpose();
    root.col(rank) = column / std::sqrt(left(pivot));
    left -= root.col(rank).cwiseAbs2();
    left(pivot) = 0;
  }
  return root;
}

/// Correlation and its derivative with respect to log ℓ between the functions of a basis. A diagonal matrix
/// is a single column.
struct AxisMatrix {
  bool diagonal = true;
  MatrixXd value, slope, root;
  Index size() const { return value.rows(); }
  Index rank() const { return diagonal ? value.rows() : root.cols(); }
};

AxisMatrix axis_matrix(const Basis& basis, const Shape& shape) {
  if (shape.kind == Shape::Kind::constant)
    return {true, MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1), MatrixXd::Ones(1, 1)};
  if (shape.kind == Shape::Kind::periodic) {
    const PeriodicWeights weights = periodic_weights(shape.length, basis.size);
    const Eigen::Map<const VectorXd> value(weights.value.data(), basis.size),
        slope(weights.slope.data(), basis.size);
    return {true, value, slope, value.cwiseSqrt()};
  }
  const std::vector<double> z = nodes_of(basis);
  const auto n = Index(z.size());
  AxisMatrix result{false, MatrixXd(n, n), MatrixXd(n, n), {}};
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const double r = z[size_t(i)] - z[size_t(j)];
      result.value(i, j) = correlation(shape, r);
      result.slope(i, j) = length_slope(shape, r);
    }
  result.root = low_rank_root(result.value);
  return result;
}

/// S_t = σ² K₀ ⊗ K₁ over the features (a₀, a₁), a₁ varying fastest. The features begin at `begin`.
struct TermMatrix {
  double deviation;
  std::array<AxisMatrix, 2> axis;
  Index begin, first_column;
  Index size() const { return axis[0].size() * axis[1].size(); }
  Index rank() const { return axis[0].rank() * axis[1].rank(); }
  bool diagonal() const { return axis[0].diagonal && axis[1].diagonal; }
};

/// X (R₀ ⊗ R₁). X has as many columns as the term has features.
MatrixXd times_axes(const TermMatrix& term, const MatrixXd& x) {
  const auto& [first, second] = term.axis;
  const Index n0 = first.size(), n1 = second.size(), r0 = first.rank(), r1 = second.rank();
  MatrixXd half(x.rows(), n0 * r1);
  for (Index a = 0; a < n0; ++a) {
    auto to = half.middleCols(a * r1, r1);
    if (second.diagonal)
      to = x.middleCols(a * n1, n1) * second.root.col(0).asDiagonal();
    else
      to.noalias() = x.middleCols(a * n1, n1) * second.root;
  }
  MatrixXd whole(x.rows(), r0 * r1);
  for (Index b = 0; b < r1; ++b) {
    const MatrixXd from = half(Eigen::all, Eigen::seqN(b, n0, r1));
    if (first.diagonal)
      whole(Eigen::all, Eigen::seqN(b, r0, r1)) = from * first.root.col(0).asDiagonal();
    else
      whole(Eigen::all, Eigen::seqN(b, r0, r1)) = (from * first.root).eval();
  }
  return term.deviation * whole;
}

/// The features and labels of the statistics for one choice of sizes: G = ΦᵀΦ and b = Φᵀy.
struct Gram {
  std::vector<std::array<Basis, 2>> bases;  ///< of each term
  std::vector<Index> begin;                 ///< first feature of each term; last: number of features
  MatrixXd g;
  VectorXd b;
};

/// Transforms features T_k into the cardinal functions of the Chebyshev nodes, for the rows of one term.
void to_nodes(MatrixXd& x, Index begin, const std::array<Basis, 2>& bases) {
  const Index n0 = bases[0].size, n1 = bases[1].size;
  for (size_t d = 0; d < 2; ++d) {
    if (bases[d].kind != Basis::Kind::chebyshev) continue;
    const int n = bases[d].size;
    MatrixXd cardinal(n, n);  // of node a in row a
    for (int a = 0; a < n; ++a)
      for (int k = 0; k < n; ++k)
        cardinal(a, k) = (k == 0 ? 1.0 : 2.0) / n * cosine(std::numbers::pi * k * (a + 0.5) / n);
    if (d == 0)
      for (Index j = 0; j < n1; ++j) {
        const auto rows = Eigen::seqN(begin + j, n0, n1);
        const MatrixXd before = x(rows, Eigen::all);
        x(rows, Eigen::all) = (cardinal * before).eval();
      }
    else
      for (Index i = 0; i < n0; ++i)
        x.middleRows(begin + i * n1, n1) = (cardinal * x.middleRows(begin + i * n1, n1)).eval();
  }
}

/// The index of a feature in the row or column of moments of its axis; -1 for constants.
int place(const Basis& of_term, Index feature) {
  return of_term.kind == Basis::Kind::constant ? -1 : int(feature);
}

Gram gram_of(const Statistics& statistics, std::vector<std::array<Basis, 2>> bases) {
  Gram gram{std::move(bases), {0}, {}, {}};
  for (const auto& [x, v] : gram.bases) gram.begin.push_back(gram.begin.back() + Index(x.size) * v.size);
  const Index m = gram.begin.back();
  gram.g.resize(m, m);
  gram.b.resize(m);
  const Basis &along_x = statistics.bases[0], &along_v = statistics.bases[1];
  const size_t columns = size_t(moment_count(along_v));
  const size_t label_columns = statistics.label_moments.size() /
                               size_t(along_x.kind == Basis::Kind::levels ? along_x.size + 1 : along_x.size);
  const auto for_each_feature = [&](auto&& f) {
    for (size_t t = 0; t < gram.bases.size(); ++t)
      for (Index i = 0, at = gram.begin[t]; i < gram.bases[t][0].size; ++i)
        for (Index j = 0; j < gram.bases[t][1].size; ++j, ++at)
          f(at, place(gram.bases[t][0], i), place(gram.bases[t][1], j));
  };
  std::vector<std::array<int, 2>> places;
  for_each_feature([&](Index, int i, int j) { places.push_back({i, j}); });
  const auto label_place = [](const Basis& basis, int i) {
    return size_t(i >= 0 ? i : basis.kind == Basis::Kind::levels ? basis.size : 0);
  };
  for (Index k = 0; k < m; ++k) {
    const auto [i, j] = places[size_t(k)];
    gram.b(k) = statistics.label_moments[label_place(along_x, i) * label_columns + label_place(along_v, j)];
    for (Index l = 0; l <= k; ++l) {
      const Pairing q = pairing(along_x, i, places[size_t(l)][0]),
                    p = pairing(along_v, j, places[size_t(l)][1]);
      double sum = 0;
      for (int a = 0; a < q.count; ++a)
        for (int c = 0; c < p.count; ++c)
          sum += q.weight[a] * p.weight[c] *
                 statistics.moments[size_t(q.moment[a]) * columns + size_t(p.moment[c])];
      gram.g(k, l) = gram.g(l, k) = sum;
    }
  }
  for (size_t t = 0; t < gram.bases.size(); ++t) {
    to_nodes(gram.g, gram.begin[t], gram.bases[t]);
    MatrixXd b = gram.b;
    to_nodes(b, gram.begin[t], gram.bases[t]);
    gram.b = b;
  }
  gram.g.transposeInPlace();
  for (size_t t = 0; t < gram.bases.size(); ++t) to_nodes(gram.g, gram.begin[t], gram.bases[t]);
  return gram;
}

std::vector<std::array<Basis, 2>> bases_of(const Statistics& statistics, const Kernel& kernel) {
  std::vector<std::array<Basis, 2>> bases;
  for (const Term& term : kernel.terms)
    bases.push_back({basis_of(statistics, term.along[0], 0), basis_of(statistics, term.along[1], 1)});
  return bases;
}

/// The quantities that evidence and posterior share, for one kernel.
struct Solution {
  Solution(const Statistics& statistics, const Gram& gram, const Kernel& kernel);

  std::vector<TermMatrix> terms;
  double noise_square, quadratic, log_determinant, residual_square, trace;
  Eigen::LLT<MatrixXd> root;  ///< of B
  MatrixXd half;              ///< root⁻¹ (GL)ᵀ/σ_n: Z = (G - halfᵀ half)/σ_n²
  VectorXd whitened, beta;    ///< Lᵀβ, and β = Φᵀ(K + σ_n² I)⁻¹y
  VectorXd inverse_diagonal;  ///< of B⁻¹
};

Solution::Solution(const Statistics& statistics, const Gram& gram, const Kernel& kernel)
    : noise_square(square(kernel.noise)) {
  Index rank = 0;
  for (size_t t = 0; t < kernel.terms.size(); ++t) {
    const Term& term = kernel.terms[t];
    terms.push_back(
        {term.deviation,
         {axis_matrix(gram.bases[t][0], term.along[0]), axis_matrix(gram.bases[t][1], term.along[1])},
         gram.begin[t],
         rank});
    rank += terms.back().rank();
  }
  const auto times_root = [&](const MatrixXd& x) {
    MatrixXd result(x.rows(), rank);
    for (const TermMatrix& t : terms)
      result.middleCols(t.first_column, t.rank()) = times_axes(t, x.middleCols(t.begin, t.size()));
    return result;
  };
  const MatrixXd gl = times_root(gram.g);
  MatrixXd b = times_root(gl.transpose()) / noise_square;
  const VectorXd projected = times_root(gram.b.transpose()).transpose();
  b.diagonal().array() += 1;
  root.compute(b);
  const auto lower = root.matrixL();
  const VectorXd u = lower.solve(projected);
  quadratic = (statistics.label_square - u.squaredNorm() / noise_square) / noise_square;
  log_determinant = double(statistics.count) * natural_logarithm(noise_square);
  for (Index i = 0; i < rank; ++i) log_determinant += 2 * natural_logarithm(root.matrixLLT()(i, i));
  whitened = lower.transpose().solve(u) / noise_square;
  beta = (gram.b - gl * whitened) / noise_square;
  // y - mean = y - ΦL whitened, and LᵀGL = σ_n² (B - I)
  residual_square = statistics.label_square - 2 * whitened.dot(projected) +
                    noise_square * (whitened.dot(b * whitened) - whitened.squaredNorm());
  half = lower.solve(gl.transpose()) / kernel.noise;
  inverse_diagonal = lower.solve(MatrixXd::Identity(rank, rank)).colwise().squaredNorm().transpose();
  trace = (double(statistics.count) - double(rank) + inverse_diagonal.sum()) / noise_square;
}

/// Σ Z∘(X₀ ⊗ X₁) over one term, where one factor is a derivative.
double contracted(const Solution& solution, const MatrixXd& g, const TermMatrix& term, const MatrixXd& x0,
                  const MatrixXd& x1) {
  const Index n0 = term.axis[0].size(), n1 = term.axis[1].size();
  const auto z = [&](Index i, Index rows, Index j, Index columns) -> MatrixXd {
    return g.block(term.begin + i, term.begin + j, rows, columns) -
           solution.half.middleCols(term.begin + i, rows).transpose() *
               solution.half.middleCols(term.begin + j, columns);
  };
  double sum = 0;
  if (term.diagonal()) {
    for (Index i = 0; i < n0; ++i)
      for (Index j = 0; j < n1; ++j) {
        const Index at = term.begin + i * n1 + j;
        sum += (g(at, at) - solution.half.col(at).squaredNorm()) * x0(i, 0) * x1(j, 0);
      }
  } else if (term.axis[0].diagonal) {
    for (Index i = 0; i < n0; ++i) sum += x0(i, 0) * z(i * n1, n1, i * n1, n1).cwiseProduct(x1).sum();
  } else {
    const MatrixXd all = z(0, n0 * n1, 0, n0 * n1);
    for (Index i = 0; i < n0; ++i)
      for (Index j = 0; j < n0; ++j) {
        const auto block = all.block(i * n1, j * n1, n1, n1);
        sum += x0(i, j) *
               (term.axis[1].diagonal ? block.diagonal().dot(x1.col(0)) : block.cwiseProduct(x1).sum());
      }
  }
  return sum / solution.noise_square;
}

/// βᵀ(X₀ ⊗ X₁)β over one term.
double quadratic_form(const Solution& solution, const TermMatrix& term, const MatrixXd& x0,
                      const MatrixXd& x1) {
  const Index n0 = term.axis[0].size(), n1 = term.axis[1].size();
  const Eigen::Map<const MatrixXd> beta(solution.beta.data() + term.begin, n1, n0);
  const MatrixXd left = term.axis[1].diagonal ? MatrixXd(x1.col(0).asDiagonal() * beta) : MatrixXd(x1 * beta);
  const MatrixXd both = beta.transpose() * left;  // n0 × n0
  return term.axis[0].diagonal ? both.diagonal().dot(x0.col(0)) : both.cwiseProduct(x0).sum();
}

}  // namespace

struct StructuredEvidence::Workspace {
  const Statistics& statistics;
  Gram gram;
};

StructuredEvidence::StructuredEvidence(const Statistics& statistics)
    : workspace_(std::make_unique<Workspace>(Workspace{statistics, {}})) {}
StructuredEvidence::~StructuredEvidence() = default;

Evidence StructuredEvidence::operator()(const Kernel& kernel) {
  const Statistics& statistics = workspace_->statistics;
  Gram& gram = workspace_->gram;
  if (auto bases = bases_of(statistics, kernel); bases != gram.bases)
    gram = gram_of(statistics, std::move(bases));
  const Solution s(statistics, gram, kernel);
  Evidence evidence;
  if (s.root.info() != Eigen::Success) {
    evidence.value = -std::numeric_limits<double>::infinity();
    evidence.gradient.assign(parameters_of(kernel).size(), 0.0);
    return evidence;
  }
  evidence.value = -0.5 * (s.quadratic + s.log_determinant +
                           double(statistics.count) * natural_logarithm(2 * std::numbers::pi));
  // ∂/∂θ = ½ (βᵀ ∂S β - tr(Z ∂S)); for ∂S = 2S this is |Lᵀβ|² - tr(I - B⁻¹), free of cancellation.
  for (size_t t = 0; t < s.terms.size(); ++t) {
    const TermMatrix& term = s.terms[t];
    evidence.gradient.push_back(s.whitened.segment(term.first_column, term.rank()).squaredNorm() -
                                double(term.rank()) +
                                s.inverse_diagonal.segment(term.first_column, term.rank()).sum());
    for (size_t d = 0; d < 2; ++d) {
      if (kernel.terms[t].along[d].kind == Shape::Kind::constant) continue;
      const MatrixXd& x0 = d == 0 ? term.axis[0].slope : term.axis[0].value;
      const MatrixXd& x1 = d == 1 ? term.axis[1].slope : term.axis[1].value;
      evidence.gradient.push_back(0.5 * square(term.deviation) *
                                  (quadratic_form(s, term, x0, x1) - contracted(s, gram.g, term, x0, x1)));
    }
  }
  evidence.gradient.push_back(s.residual_square / s.noise_square - s.noise_square * s.trace);
  return evidence;
}

StructuredPosterior::StructuredPosterior(const Kernel& kernel, const Statistics& statistics)
    : prior_(prior_variance(kernel)) {
  const Gram gram = gram_of(statistics, bases_of(statistics, kernel));
  const Solution s(statistics, gram, kernel);
  for (size_t t = 0; t < kernel.terms.size(); ++t) {
    const Term& term = kernel.terms[t];
    TermFeatures features{square(term.deviation), term.along, {}, {}, {}, 0};
    for (size_t d = 0; d < 2; ++d) {
      const Basis& basis = gram.bases[t][d];
      if (term.along[d].kind == Shape::Kind::periodic)
        features.weights[d] = periodic_weights(term.along[d].length, basis.size).value;
      if (term.along[d].kind == Shape::Kind::squared_exponential) features.nodes[d] = nodes_of(basis);
    }
    const double* beta = s.beta.data() + gram.begin[t];
    features.coefficients.assign(beta, beta + s.terms[t].size());
    features.norm = term.deviation * s.whitened.segment(s.terms[t].first_column, s.terms[t].rank()).norm();
    terms_.push_back(std::move(features));
  }
  const auto count = double(statistics.count);
  residual_rms_ = std::sqrt(std::max(0.0, s.residual_square) / count);
  weight_sum_ = count * residual_rms_ / s.noise_square;
  functions_ = size_t(gram.begin.back());
  const MatrixXd z = (gram.g - s.half.transpose() * s.half) / s.noise_square;
  precision_.assign(z.data(), z.data() + z.size());
}

double StructuredPosterior::mean(const Point& at) const {
  double sum = 0;
  thread_local std::vector<double> x, v;  // avoids allocation during the steps of a run
  for (const TermFeatures& term : terms_) {
    x.resize(term.size(0)), v.resize(term.size(1));
    correlations(term, 0, at[0], x.data());
    correlations(term, 1, at[1], v.data());
    double of_term = 0;
    const double* beta = term.coefficients.data();
    for (const double c : x)
      for (const double d : v) of_term += c * d * *beta++;
    sum += term.variance * of_term;
  }
  return sum;
}

Jet StructuredPosterior::term(size_t index, const Point& at) const { return jet_of(terms_[index], at); }

double StructuredPosterior::variance(const Point& at) const {
  thread_local std::vector<double> x, v, features;
  features.resize(functions_);
  Eigen::Map<VectorXd> seen(features.data(), Index(functions_));
  Index i = 0;
  for (const TermFeatures& term : terms_) {
    x.resize(term.size(0)), v.resize(term.size(1));
    correlations(term, 0, at[0], x.data());
    correlations(term, 1, at[1], v.data());
    for (const double c : x)
      for (const double d : v) seen(i++) = term.variance * c * d;
  }
  const Eigen::Map<const MatrixXd> z(precision_.data(), i, i);
  double explained = 0;  // by columns below the diagonal: half the operations
  for (Index j = 0; j < i; ++j)
    explained += seen(j) * (z(j, j) * seen(j) + 2 * z.col(j).tail(i - j - 1).dot(seen.tail(i - j - 1)));
  return std::max(0.0, prior_ - explained);
}

}  // namespace loopwright::gp
