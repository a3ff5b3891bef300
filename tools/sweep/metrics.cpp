#include "tools/sweep/metrics.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/json/reader.h"
#include "models/real/whole.h"
#include "tools/sweep/metric_expression.h"

namespace loopwright {
namespace {

/// Numbers of the metric that were written with a unit of their own.
void check_stated(const Metric& metric, const std::optional<Unit>& of_signal,
                  const std::optional<Unit>& of_result, Problems& problems) {
  for (const Metric::Stated& stated : metric.stated) {
    const auto& wanted = stated.is_of_signal ? of_signal : of_result;
    const bool is_difference = stated.key == "band" || stated.key == "threshold" || !stated.is_of_signal;
    const bool fits = !wanted || conversion(stated.unit, *wanted).kind == Conversion::Kind::none;
    if (fits && !(is_difference && stated.unit.is_point)) continue;
    auto& p = problems.error(stated.place, stated.place.pointer(), "",
                             fmt::format("\"{}\" has another unit than the {}", stated.key,
                                         stated.is_of_signal ? "signal" : "metric"));
    p.expected = fmt::format("a number in {}", wanted ? to_string(*wanted) : "K");
    p.found = to_string(stated.unit);
    if (fits) p.hint = "a metric may be a difference: it takes K";
  }
}

}  // namespace

Observed observe(const Sweep& sweep, const Plan& plan, Problems& problems) {
  Observed observed;
  for (const Metric& metric : sweep.metrics) {
    auto& of_metric = observed.of_metric.emplace_back();
    std::vector<std::optional<Unit>> units_of_ports;
    const auto ports = ports_of(metric, problems);
    for (const std::string& port : ports) {
      const std::vector<Number> numbers = plan.find(port);
      if (numbers.size() == 1) {
        const auto at = std::find(observed.numbers.begin(), observed.numbers.end(), numbers[0]);
        of_metric.push_back(size_t(at - observed.numbers.begin()));
        if (at == observed.numbers.end()) observed.numbers.push_back(numbers[0]);
        units_of_ports.push_back(plan.unit_of(numbers[0]));
        continue;
      }
      auto& p =
          problems.error(metric.place, metric.pointer, "",
                         numbers.empty() ? fmt::format("there is no signal \"{}\"", port)
                                         : fmt::format("\"{}\" is a vector of {}", port, numbers.size()));
      if (!numbers.empty()) p.hint = fmt::format("name one element, as in \"{}[0]\"", port);
      KnownNames known;
      for (const Plan::Port& other : plan.ports) known.add(std::string(other.name));
      if (numbers.empty()) known.explain(p, port);
    }
    std::optional<Unit> unit;
    if (is_expression(metric.signal))
      unit = unit_of_expression(metric, ports, units_of_ports, problems);
    else if (!units_of_ports.empty())
      unit = units_of_ports.front();
    const auto of_signal = unit;
    if (metric.is_time()) unit = parse_unit("s");
    check_stated(metric, of_signal, unit, problems);
    const auto stated = metric.unit.empty() ? unit : parse_unit(metric.unit);
    double scale = metric.unit.empty() || !stated ? 1.0 : stated->scale;
    if (stated && unit) {
      const Conversion to_stated = conversion(*unit, *stated);
      const bool is_possible =
          to_stated.kind == Conversion::Kind::none || to_stated.kind == Conversion::Kind::turns;
      if (!is_possible || stated->is_point) {
        auto& p = problems.error(metric.place, metric.pointer, "", "the metric has another unit");
        p.expected = to_string(*unit), p.found = metric.unit;
        if (stated->is_point) p.hint = "a metric may be a difference: it takes K";
      }
      scale /= to_stated(1.0);
    }
    observed.units.push_back(!metric.unit.empty() ? metric.unit : unit ? to_string(*unit) : "");
    observed.scales.push_back(scale);
  }
  return observed;
}

/// One metric for all lanes. Without rows in its window a metric is NaN.
struct MetricBank::Accumulator {
  Accumulator(const Metric& m, std::vector<size_t> of, double unit_scale, int count)
      : metric(m),
        numbers(std::move(of)),
        scale(unit_scale),
        lanes(size_t(count)),
        signal(lanes),
        a(lanes),
        b(lanes) {
    if (!is_expression(metric.signal)) return;
    arguments.resize(numbers.size());
    parser = metric_parser();
    Problems none;
    const auto ports = ports_of(metric, none);
    for (size_t i = 0; i < ports.size(); ++i) parser.DefineVar(ports[i], &arguments[i]);
    parser.set_formula(metric.signal.substr(1));
  }

  void reset() {
    rows = 0;
    for (auto& values : kept) values.clear();
  }

  void add(double time, const double* values) {
    if (time < metric.from || time > metric.to) return;
    const double* x = evaluate(values);
    const bool is_first = rows++ == 0;
    switch (metric.kind) {
      case Metric::Kind::rms:
        each(is_first, [&](size_t l) { a[l] += x[l] * x[l]; });
        break;
      case Metric::Kind::mean:
        each(is_first, [&](size_t l) { a[l] += x[l]; });
        break;
      case Metric::Kind::maximum:
        each_from(is_first, x, [&](size_t l) { a[l] = x[l] > a[l] ? x[l] : a[l]; });
        break;
      case Metric::Kind::minimum:
        each_from(is_first, x, [&](size_t l) { a[l] = x[l] < a[l] ? x[l] : a[l]; });
        break;
      case Metric::Kind::peak:
        each(is_first, [&](size_t l) { a[l] = std::fabs(x[l]) > a[l] ? std::fabs(x[l]) : a[l]; });
        break;
      case Metric::Kind::final:
        each(is_first, [&](size_t l) { a[l] = x[l]; });
        break;
      case Metric::Kind::settling_time:
        each(is_first, [&](size_t l) {
          b[l] = !(std::fabs(x[l] - metric.target) <= metric.band);
          if (b[l] != 0) a[l] = time - metric.from;
        });
        break;
      case Metric::Kind::overshoot:
        if (is_first) std::copy_n(x, lanes, b.begin());
        each(is_first, [&](size_t l) {
          const double beyond = b[l] <= metric.target ? x[l] - metric.target : metric.target - x[l];
          a[l] = beyond > a[l] ? beyond : a[l];
        });
        break;
      case Metric::Kind::percentile:
        kept.resize(lanes);
        for (size_t l = 0; l < lanes; ++l) kept[l].push_back(x[l]);
        break;
      case Metric::Kind::first_violation:
        if (is_first) std::fill(a.begin(), a.end(), std::nan(""));
        for (size_t l = 0; l < lanes; ++l)
          if (std::isnan(a[l]) && std::fabs(x[l]) > metric.threshold) a[l] = time;
        break;
    }
  }

  double result(size_t l) {
    const bool never_settles = metric.kind == Metric::Kind::settling_time && b[l] != 0;
    if (rows == 0 || never_settles) return std::nan("");
    double value = a[l];
    if (metric.kind == Metric::Kind::rms) value = std::sqrt(a[l] / double(rows));
    if (metric.kind == Metric::Kind::mean) value = a[l] / double(rows);
    if (metric.kind == Metric::Kind::percentile) {
      auto& values = kept[l];
      const double rank = std::ceil(metric.percent / 100 * double(values.size()));
      const auto at = values.begin() + ptrdiff_t(whole_index(rank - 1, values.size()));
      std::nth_element(values.begin(), at, values.end());
      value = *at;
    }
    return value / scale;
  }

  template <class F> void each(bool is_first, F&& f) {
    if (is_first) std::fill(a.begin(), a.end(), 0.0);
    for (size_t l = 0; l < lanes; ++l) f(l);
  }
  template <class F> void each_from(bool is_first, const double* x, F&& f) {
    if (is_first) std::copy_n(x, lanes, a.begin());
    for (size_t l = 0; l < lanes; ++l) f(l);
  }
  const double* evaluate(const double* values) {
    if (!is_expression(metric.signal)) return values + numbers[0] * lanes;
    for (size_t l = 0; l < lanes; ++l) {
      for (size_t i = 0; i < numbers.size(); ++i) arguments[i] = values[numbers[i] * lanes + l];
      signal[l] = parser.Eval();
    }
    return signal.data();
  }

  const Metric& metric;
  std::vector<size_t> numbers;
  double scale;
  size_t lanes;
  int64_t rows = 0;
  std::vector<double> signal, a, b;
  std::vector<std::vector<double>> kept;
  std::vector<double> arguments;
  FormulaParser parser;
};

MetricBank::MetricBank(const Sweep& sweep, const Observed& observed, int lanes) {
  for (size_t m = 0; m < sweep.metrics.size(); ++m)
    accumulators_.push_back(
        std::make_unique<Accumulator>(sweep.metrics[m], observed.of_metric[m], observed.scales[m], lanes));
}
MetricBank::~MetricBank() = default;

void MetricBank::reset() {
  for (auto& accumulator : accumulators_) accumulator->reset();
}
void MetricBank::add(double time, const double* values) {
  for (auto& accumulator : accumulators_) accumulator->add(time, values);
}
std::vector<double> MetricBank::results(int lane) {
  std::vector<double> results;
  for (auto& accumulator : accumulators_) results.push_back(accumulator->result(size_t(lane)));
  return results;
}

}  // namespace loopwright
