#include "tools/compare/smoother.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/random/philox.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using std::numbers::pi;
using Matrix = Eigen::MatrixXd;
using Vector_ = Eigen::VectorXd;

constexpr int folds = 8, surrogates = 19;

/// Two hat functions share each value: weights of the left and the right one.
struct Hats {
  double low = 0, step = 1;
  int count = 2;
  Hats(const std::vector<double>& values, int wanted) : count(wanted) {
    const auto [least, most] = std::ranges::minmax(values);
    low = least, step = std::max((most - least) / (count - 1), 1e-300);
  }
  std::pair<int, double> at(double value) const {
    const double place = std::clamp((value - low) / step, 0.0, double(count - 1) - 1e-9);
    return {int(place), place - std::floor(place)};
  }
};

/// Share of the variance that hat functions explain on left-out folds, for a residual with signs per block.
double cross_validated(const Rows& rows, const std::vector<double>& variable, int hats_count,
                       const std::vector<double>& sign_of_block) {
  const Hats hats(variable, hats_count);
  std::vector<Matrix> gram(folds, Matrix::Zero(hats_count, hats_count));
  std::vector<Vector_> right(folds, Vector_::Zero(hats_count));
  const size_t n = rows.residual.size();
  const auto value = [&](size_t i) { return rows.residual[i] * sign_of_block[size_t(rows.block[i])]; };
  for (size_t i = 0; i < n; ++i) {
    const int fold = rows.block[i] % folds;
    const auto [j, w] = hats.at(variable[i]);
    Matrix& g = gram[size_t(fold)];
    g(j, j) += (1 - w) * (1 - w), g(j, j + 1) += w * (1 - w), g(j + 1, j) += w * (1 - w),
        g(j + 1, j + 1) += w * w;
    right[size_t(fold)](j) += (1 - w) * value(i), right[size_t(fold)](j + 1) += w * value(i);
  }
  Matrix all = Matrix::Zero(hats_count, hats_count);
  Vector_ all_right = Vector_::Zero(hats_count);
  for (int f = 0; f < folds; ++f) all += gram[size_t(f)], all_right += right[size_t(f)];
  std::vector<Vector_> weights;
  const double ridge = 1e-3 * all.trace() / hats_count + 1e-12;
  for (int f = 0; f < folds; ++f) {
    Matrix g = all - gram[size_t(f)];
    g.diagonal().array() += ridge;
    weights.push_back(g.ldlt().solve(all_right - right[size_t(f)]));
  }
  double before = 0, after = 0;
  for (size_t i = 0; i < n; ++i) {
    const auto [j, w] = hats.at(variable[i]);
    const Vector_& c = weights[size_t(rows.block[i] % folds)];
    const double left = value(i) - (1 - w) * c(j) - w * c(j + 1);
    before += value(i) * value(i), after += left * left;
  }
  return before > 0 ? 1 - after / before : 0;
}

/// Signs that remove every dependence from a residual but leave each block unchanged.
std::vector<double> random_signs(int blocks, int surrogate) {
  std::vector<double> signs;
  for (int b = 0; b < blocks; ++b) {
    const auto word = philox({uint32_t(b), uint32_t(surrogate), 0, 0}, {0x57a7u, 0x5165u})[0];
    signs.push_back(word & 1 ? 1.0 : -1.0);
  }
  return signs;
}

struct Line {
  double frequency = 0, sine = 0, cosine = 0, power = 0;
};

/// Least squares of a sine and a cosine on some rows.
class LineFit {
 public:
  LineFit(const std::vector<double>& residual, const std::vector<double>& variable, const Rows& rows,
          int parity) {
    for (size_t i = 0; i < residual.size(); ++i)
      if (parity < 0 || rows.block[i] % 2 == parity)
        residual_.push_back(residual[i]), variable_.push_back(variable[i]);
    for (auto* list : {&now_, &onward_}) list->resize(residual_.size());
  }
  Line at(double frequency) {
    turn(frequency, now_);
    return present(frequency);
  }
  /// The strongest at lowest, lowest + spacing, …: each phase turns on from one frequency to the next, which
  /// costs a part of a sine and a cosine.
  Line strongest(double lowest, double highest, double spacing) {
    turn(lowest, now_), turn(spacing, onward_);
    Line best;
    for (double f = lowest; f <= highest; f += spacing) {
      if (const Line line = present(f); line.power > best.power) best = line;
      for (size_t i = 0; i < now_.size(); ++i) {
        const auto [c, s] = now_[i];
        const auto [turned_c, turned_s] = onward_[i];
        now_[i] = {c * turned_c - s * turned_s, s * turned_c + c * turned_s};
      }
    }
    return best;
  }

 private:
  struct Phase {
    double cosine = 1, sine = 0;
  };
  void turn(double frequency, std::vector<Phase>& phases) const {
    for (size_t i = 0; i < phases.size(); ++i) {
      const double angle = 2 * pi * frequency * variable_[i];
      phases[i] = {std::cos(angle), std::sin(angle)};
    }
  }
  Line present(double frequency) const {
    double ss = 0, cc = 0, sc = 0, sr = 0, cr = 0;
    for (size_t i = 0; i < now_.size(); ++i) {
      const auto [c, s] = now_[i];
      ss += s * s, cc += c * c, sc += s * c, sr += s * residual_[i], cr += c * residual_[i];
    }
    const double determinant = ss * cc - sc * sc;
    if (determinant <= 1e-9 * (ss + cc) * (ss + cc)) return {frequency};
    Line line{frequency, (cc * sr - sc * cr) / determinant, (ss * cr - sc * sr) / determinant};
    line.power = line.sine * sr + line.cosine * cr;
    return line;
  }

  std::vector<double> residual_, variable_;
  std::vector<Phase> now_, onward_;
};

/// The strongest spectral line on rows of one parity (-1: all), from a uniform grid of frequencies and a
/// refinement around the best one.
Line find_line(const std::vector<double>& residual, const Rows& rows, const std::vector<double>& variable,
               int parity) {
  const auto [low, high] = std::ranges::minmax(variable);
  const double extent = high - low;
  std::vector<double> steps;
  for (size_t i = 1; i < variable.size(); ++i) steps.push_back(std::abs(variable[i] - variable[i - 1]));
  if (steps.empty() || extent <= 0) return {};
  std::ranges::nth_element(steps, steps.begin() + ptrdiff_t(steps.size() / 2));
  const double shortest = std::max(2.2 * steps[steps.size() / 2], extent / 3000);
  const double spacing = 0.5 / extent, highest = 1 / shortest;
  LineFit fit(residual, variable, rows, parity);
  Line best = fit.strongest(2 * spacing, highest, spacing);
  for (double width = 0.5 * spacing; width > 1e-3 * spacing; width *= 0.5)
    for (double f : {best.frequency - width, best.frequency + width})
      if (const Line line = fit.at(f); line.power > best.power) best = line;
  return best;
}

}  // namespace

Rows thinned(const MeasuredMotion& m, const std::vector<double>& residual) {
  Rows rows;
  const size_t step = std::max<size_t>(1, whole_count(std::round(0.005 / m.sample_time)));
  const size_t most = 6000, wanted = std::max(step, m.rows() / most);
  const double block = std::max(0.4, std::min(1.25, double(m.rows()) * m.sample_time / 32));
  for (size_t k = 0; k < m.rows(); k += wanted) {
    if (!m.counts[k]) continue;
    rows.index.push_back(k);
    rows.residual.push_back(residual[k]);
    rows.position.push_back(m.position[k]), rows.velocity.push_back(m.velocity[k]);
    rows.acceleration.push_back(m.acceleration[k]), rows.time.push_back(m.time[k]);
    rows.block.push_back(int(whole_count(double(k) * m.sample_time / block)));
    rows.blocks = rows.block.back() + 1;
  }
  return rows;
}

Dependence explained_by(const Rows& rows, std::string name, const std::vector<double>& variable) {
  Dependence result{std::move(name)};
  if (rows.residual.size() < 50 || rows.blocks < folds) return result;
  const int count = result.variable == "direction" ? 2 : result.variable == "time" ? 10 : 24;
  result.share = cross_validated(rows, variable, count, std::vector<double>(size_t(rows.blocks), 1.0));
  for (int s = 0; s < surrogates; ++s)
    result.by_chance =
        std::max(result.by_chance, cross_validated(rows, variable, count, random_signs(rows.blocks, s)));
  if (result.share <= std::max(result.by_chance, 0.005)) result.share = 0;
  return result;
}

Dependence strongest_line(const Rows& rows, std::string name, const std::vector<double>& variable) {
  Dependence result{std::move(name)};
  if (rows.residual.size() < 50 || rows.blocks < 4) return result;
  const Line line = find_line(rows.residual, rows, variable, 0);
  double before = 0, after = 0;
  for (size_t i = 0; i < rows.residual.size(); ++i) {
    if (rows.block[i] % 2 == 0) continue;
    const double angle = 2 * pi * line.frequency * variable[i];
    const double left = rows.residual[i] - line.sine * std::sin(angle) - line.cosine * std::cos(angle);
    before += rows.residual[i] * rows.residual[i], after += left * left;
  }
  result.share = before > 0 ? 1 - after / before : 0;
  result.at = line.frequency;
  result.by_chance = 4.0 / double(rows.blocks);  // two numbers from this many independent pieces
  if (result.share <= std::max(0.005, std::min(result.by_chance, 0.05))) result.share = 0;
  return result;
}

double floor_of_smooth_parts(const Rows& rows) {
  const size_t n = rows.residual.size();
  if (n < 200) return 0;
  std::vector<double> direction;
  for (double v : rows.velocity) direction.push_back(v > 0 ? 1 : -1);
  struct Family {
    const std::vector<double>* variable;
    const std::vector<double>* factor;
    int count;
  };
  const int fine = int(std::min<size_t>(30, n / 60));
  const Family families[] = {{&rows.position, nullptr, fine},   {&rows.velocity, nullptr, fine},
                             {&rows.time, nullptr, 12},         {&rows.position, &direction, fine},
                             {&rows.acceleration, nullptr, 10}, {&rows.acceleration, &direction, 4}};
  constexpr int lines = 3;
  int columns = 6 * lines;
  for (const Family& f : families) columns += f.count;
  std::vector<double> left = rows.residual;
  Matrix design = Matrix::Zero(Eigen::Index(n), columns);
  int at = 0;
  for (const Family& f : families) {
    const Hats hats(*f.variable, f.count);
    for (size_t i = 0; i < n; ++i) {
      const auto [j, w] = hats.at((*f.variable)[i]);
      const double factor = f.factor ? (*f.factor)[i] : 1;
      design(Eigen::Index(i), at + j) += factor * (1 - w), design(Eigen::Index(i), at + j + 1) += factor * w;
    }
    at += f.count;
  }
  // Of the columns so far: those that are added leave the products of the others as they are.
  Matrix products = Matrix::Zero(columns, columns);
  const auto add_products = [&](int from) {
    products.block(0, from, at, at - from).noalias() =
        design.leftCols(at).transpose() * design.middleCols(from, at - from);
    products.block(from, 0, at - from, from) = products.block(0, from, from, at - from).transpose();
  };
  const auto solve = [&] {
    const Eigen::Map<const Vector_> r(rows.residual.data(), Eigen::Index(n));
    const auto part = design.leftCols(at);
    Matrix gram = products.topLeftCorner(at, at);
    gram.diagonal().array() += 1e-6 * gram.trace() / at + 1e-12;
    const Vector_ remainder = r - part * gram.ldlt().solve(part.transpose() * r);
    std::copy_n(remainder.data(), n, left.begin());
  };
  add_products(0);
  solve();
  // Of the top speed, so that all columns are alike in size whatever the unit of the position.
  const auto faster = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const double top_speed = std::max(std::abs(*std::ranges::max_element(rows.velocity, faster)), 1e-300);
  for (int l = 0; l < lines; ++l) {  // the line itself, and the line multiplied by speed and by its square
    const Line line = find_line(left, rows, rows.position, -1);
    for (size_t i = 0; i < n; ++i) {
      const double angle = 2 * pi * line.frequency * rows.position[i], v = rows.velocity[i] / top_speed;
      double factor = 1;
      for (int power = 0; power < 3; ++power, factor *= std::abs(v)) {
        design(Eigen::Index(i), at + 2 * power) = factor * std::sin(angle);
        design(Eigen::Index(i), at + 2 * power + 1) = factor * std::cos(angle);
      }
    }
    at += 6;
    add_products(at - 6);
    solve();
  }
  double sum = 0;
  for (double r : left) sum += r * r;
  return std::sqrt(sum / std::max(1.0, double(n) - at));
}

}  // namespace loopwright
