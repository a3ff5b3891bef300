#include "tools/compare/smoother.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/random/philox.h"
#include "models/real/whole.h"
#include "models/statistics/smoother.h"

namespace loopwright {
namespace {

using std::numbers::pi;

constexpr size_t folds = 8;
constexpr int surrogates = 19;

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
  if (rows.residual.size() < 50 || rows.blocks < int(folds)) return result;
  const size_t count = result.variable == "direction" ? 2 : result.variable == "time" ? 10 : 24;
  const Hats hats = Hats::at_equal_distances(variable, count);
  CrossValidation validation{{}, count, {}, folds};
  for (size_t i = 0; i < variable.size(); ++i)
    validation.places.push_back(hats.at(variable[i])),
        validation.fold.push_back(size_t(rows.block[i]) % folds);
  result.share = validation.share_of(rows.residual);
  for (int s = 0; s < surrogates; ++s) {
    const std::vector<double> signs = random_signs(rows.blocks, s);
    std::vector<double> surrogate = rows.residual;
    for (size_t i = 0; i < surrogate.size(); ++i) surrogate[i] *= signs[size_t(rows.block[i])];
    result.by_chance = std::max(result.by_chance, validation.share_of(surrogate));
  }
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
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(Eigen::Index(n), columns);
  int at = 0;
  for (const Family& f : families) {
    const Hats hats = Hats::at_equal_distances(*f.variable, size_t(f.count));
    for (size_t i = 0; i < n; ++i) {
      const auto [knot, w] = hats.at((*f.variable)[i]);
      const double factor = f.factor ? (*f.factor)[i] : 1;
      const Eigen::Index column = at + Eigen::Index(knot);
      design(Eigen::Index(i), column) += factor * (1 - w), design(Eigen::Index(i), column + 1) += factor * w;
    }
    at += f.count;
  }
  // Of the columns so far: those that are added leave the products of the others as they are.
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(columns, columns);
  const auto add_products = [&](int from) {
    products.block(0, from, at, at - from).noalias() =
        design.leftCols(at).transpose() * design.middleCols(from, at - from);
    products.block(from, 0, at - from, from) = products.block(0, from, from, at - from).transpose();
  };
  const auto solve = [&] {
    const Eigen::Map<const Eigen::VectorXd> r(rows.residual.data(), Eigen::Index(n));
    const auto part = design.leftCols(at);
    Eigen::MatrixXd gram = products.topLeftCorner(at, at);
    gram.diagonal().array() += 1e-6 * gram.trace() / at + 1e-12;
    const Eigen::VectorXd remainder = r - part * gram.ldlt().solve(part.transpose() * r);
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
