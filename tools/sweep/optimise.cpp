#include "tools/sweep/optimise.h"
#include <fmt/format.h>
#include <cmath>
#include <nlopt.hpp>
#include "engine/json/reader.h"
#include "models/real/double_functions.h"
#include "models/real/whole.h"
#include "tools/sweep/lane_group.h"

namespace loopwright {
namespace {

/// One search: the free axes from 0 to 1, the others fixed.
class Search {
 public:
  Search(const SweepPlan& plan, const OptimiseOptions& options, size_t metric, std::vector<double> start,
         Optimum& best, int total)
      : plan_(plan),
        options_(options),
        metric_(metric),
        point_(std::move(start)),
        best_(best),
        total_(total) {
    const auto [low, high] = plan.design().range();
    const auto& axes = plan.sweep().axes;
    for (size_t a = 0; a < axes.size(); ++a) {
      double from = low[a], to = high[a];
      if (axes[a].is_sampled()) from = axes[a].low, to = axes[a].high;
      if (axes[a].kind == Axis::Kind::normal)
        from = axes[a].low - 3 * axes[a].high, to = axes[a].low + 3 * axes[a].high;
      if (plan.changes_plan(a) || from == to || axes[a].pair >= 0) continue;
      free_.push_back({a, from, to, axes[a].kind == Axis::Kind::logarithmic, {}});
      for (size_t other = a + 1; other < axes.size(); ++other)
        if (axes[other].pair == int(a)) free_.back().together.push_back(other);
    }
  }

  void run() {
    const unsigned n = unsigned(free_.size());
    if (n == 0) return void(value_at({}));
    nlopt::opt everywhere(nlopt::GN_DIRECT_L, n), nearby(nlopt::LN_SBPLX, n);
    nearby.set_initial_step(0.03);  // approximate distance between the points of DIRECT
    std::vector<double> u(n, 0.5);
    search(everywhere, u, std::max(1, options_.evaluations * 2 / 3));
    if (!best_u_.empty()) search(nearby, best_u_, std::max(1, options_.evaluations - used_));
  }

 private:
  struct Free {
    size_t axis;
    double from, to;
    bool is_logarithmic;
    std::vector<size_t> together;  ///< axes paired with it
    double at(double u) const {
      return is_logarithmic ? from * any_power(to / from, u) : from + (to - from) * u;
    }
  };

  /// Paired axes go along straight lines from one pair of their lists to the next.
  void move(const Free& free, double u) {
    if (free.together.empty()) return void(point_[free.axis] = free.at(u));
    const auto along_list = [&](size_t axis) {
      const std::vector<double>& values = plan_.sweep().axes[axis].values;
      const double place = u * double(values.size() - 1);
      const size_t left = std::min(whole_index(place, values.size()), values.size() - 2);
      point_[axis] = values[left] + (place - double(left)) * (values[left + 1] - values[left]);
    };
    along_list(free.axis);
    for (const size_t axis : free.together) along_list(axis);
  }

  void search(nlopt::opt& method, std::vector<double> u, int evaluations) {
    method.set_lower_bounds(0.0), method.set_upper_bounds(1.0);
    method.set_xtol_abs(1e-6);
    method.set_maxeval(evaluations);
    method.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                void* self) { return static_cast<Search*>(self)->value_at(at); },
                             this);
    double least = 0;
    try {
      method.optimize(u, least);
    } catch (const nlopt::forced_stop&) {       // interrupted
    } catch (const nlopt::roundoff_limited&) {  // limit of double precision
    }
  }

  double value_at(const std::vector<double>& u) {
    if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) {
      best_.interrupted = true;
      throw nlopt::forced_stop();
    }
    for (size_t i = 0; i < u.size(); ++i) move(free_[i], u[i]);
    const RunRecord record = make_alone(plan_, plan_.options_at(point_), 0);
    ++used_, ++best_.evaluations;
    if (options_.progress) options_.progress(best_.evaluations, total_);
    const double value = record.metrics[metric_];
    if (!std::isfinite(value)) {
      best_.failed += record.failed;
      return 1e30;
    }
    const double cost = options_.maximise ? -value : value;
    if (cost < best_cost_) best_cost_ = cost, best_u_ = u;
    if (!best_.found || cost < (options_.maximise ? -best_.value : best_.value))
      best_.found = true, best_.value = value, best_.point = point_;
    return cost;
  }

  const SweepPlan& plan_;
  const OptimiseOptions& options_;
  const size_t metric_;
  std::vector<double> point_;
  Optimum& best_;
  const int total_;
  std::vector<Free> free_;
  std::vector<double> best_u_;
  double best_cost_ = INFINITY;
  int used_ = 0;
};

size_t metric_of(const Sweep& sweep, const std::string& name) {
  KnownNames known;
  for (size_t m = 0; m < sweep.metrics.size(); ++m) {
    if (sweep.metrics[m].name == name) return m;
    known.add(sweep.metrics[m].name);
  }
  Problems problems;
  known.explain(problems.error({}, "", "", fmt::format("the sweep has no metric \"{}\"", name)), name);
  throw InputError(std::move(problems));
}

}  // namespace

Optimum optimise(const SweepPlan& plan, const OptimiseOptions& options) {
  const size_t metric = metric_of(plan.sweep(), options.metric);
  Optimum best;
  const int64_t worlds = plan.design().worlds();
  for (int64_t w = 0; w < worlds && !best.interrupted; ++w)
    Search(plan, options, metric, plan.design().point(w * plan.design().runs_in_world()), best,
           int(worlds) * options.evaluations)
        .run();
  return best;
}

}  // namespace loopwright
