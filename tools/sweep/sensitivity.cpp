#include "tools/sweep/sensitivity.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace loopwright {
namespace {

/// Sums over runs with a finite metric.
struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double y) { n += 1, sum += y, squares += y * y; }
  double mean() const { return n > 0 ? sum / n : std::nan(""); }
  double error_of_mean() const { return n > 1 ? std::sqrt(deviations() / (n - 1) / n) : 0; }
  double deviations() const { return n > 0 ? std::max(0.0, squares - sum * sum / n) : 0; }
};

/// The variance explained by bins, minus the part that chance alone would appear to explain.
double explained(const std::vector<Moments>& bins, const Moments& all) {
  double within = 0;
  int filled = 0;
  for (const Moments& bin : bins)
    if (bin.n > 0) within += bin.deviations(), ++filled;
  const double total = all.deviations(), between = total - within;
  if (total <= 0 || all.n <= filled) return 0;
  return std::clamp((between - (filled - 1) * within / (all.n - filled)) / total, 0.0, 1.0);
}

/// Jansen's estimators over the complete blocks of Saltelli's design, summed over the points of the grid.
void add_saltelli(const SweepPlan& plan, const Recording& table, const std::vector<double>& y,
                  std::vector<AxisEffect>& effects) {
  const auto& axes = plan.sweep().axes;
  const int64_t count = plan.sweep().samples.count,
                sampled =
                    std::count_if(axes.begin(), axes.end(), [](const Axis&a) { return a.is_sampled(); });
  const int64_t samples = count * (sampled + 2);
  std::vector<double> of_run(size_t(plan.runs()), std::nan(""));
  for (size_t row = 0; row < y.size(); ++row) of_run[size_t(table.columns[0].values[row])] = y[row];
  int64_t rank = 0;
  for (size_t a = 0; a < axes.size(); ++a) {
    if (!axes[a].is_sampled()) continue;
    Moments total, rest, both;
    for (int64_t point = 0; point < plan.runs(); point += samples)
      for (int64_t s = 0; s < count; ++s) {
        const double in_a = of_run[size_t(point + s)], in_b = of_run[size_t(point + count + s)],
                     mixed = of_run[size_t(point + (rank + 2) * count + s)];
        if (!std::isfinite(in_a + in_b + mixed)) continue;
        total.add((in_a - mixed) * (in_a - mixed)), rest.add((in_b - mixed) * (in_b - mixed));
        both.add(in_a), both.add(in_b);
      }
    ++rank;
    const double variance = both.n > 1 ? both.deviations() / (both.n - 1) : 0;
    if (variance <= 0) continue;
    effects[a].total = std::clamp(total.mean() / (2 * variance), 0.0, 1.0);
    effects[a].total_error = total.error_of_mean() / (2 * variance);
    effects[a].first_order = std::clamp(1 - rest.mean() / (2 * variance), 0.0, 1.0);
    effects[a].first_order_error = rest.error_of_mean() / (2 * variance);
  }
}

}  // namespace

std::vector<int> bins_of(const Axis& axis, const std::vector<double>& values, int most, int& count) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const int distinct = int(sorted.size());
  count = axis.is_sampled() || distinct > most ? std::min(most, distinct) : distinct;
  std::vector<int> bins;
  for (const double value : values) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
    bins.push_back(int(at * count / std::max(1, distinct)));
  }
  return bins;
}

std::vector<AxisEffect> effects_of(const SweepPlan& plan, const Recording& table, size_t metric) {
  const auto& axes = plan.sweep().axes;
  const std::vector<double>& y = table.columns[1 + axes.size() + metric].values;
  std::vector<AxisEffect> effects;
  for (size_t a = 0; a < axes.size(); ++a) {
    AxisEffect& effect = effects.emplace_back();
    effect.axis = axes[a].name;
    const std::vector<double>& x = table.columns[1 + a].values;
    int count = 0;
    const std::vector<int> bins = bins_of(axes[a], x, most_bins, count);
    std::vector<Moments> moments(static_cast<size_t>(count));
    Moments all;
    effect.bins.resize(size_t(count), {INFINITY, -INFINITY, 0, 0});
    for (size_t row = 0; row < y.size(); ++row) {
      Bin& bin = effect.bins[size_t(bins[row])];
      bin.from = std::min(bin.from, x[row]), bin.to = std::max(bin.to, x[row]);
      if (!std::isfinite(y[row])) continue;
      moments[size_t(bins[row])].add(y[row]), all.add(y[row]);
    }
    for (size_t b = 0; b < moments.size(); ++b)
      effect.bins[b].mean = moments[b].mean(), effect.bins[b].runs = int64_t(moments[b].n);
    effect.first_order = explained(moments, all);
    // Without an effect the sum of squares between k bins is that of k - 1 normal numbers.
    effect.first_order_error = all.n > 0 ? std::sqrt(2.0 * std::max(count - 1, 0)) / all.n : 0;
  }
  if (plan.sweep().samples.method == Sampling::saltelli) add_saltelli(plan, table, y, effects);
  return effects;
}

}  // namespace loopwright
