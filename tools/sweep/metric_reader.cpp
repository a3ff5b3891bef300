#include "tools/sweep/metric_reader.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include "engine/json/stated_number.h"
#include "tools/sweep/sweep_shape.h"

namespace loopwright {
namespace {

constexpr std::array<std::pair<std::string_view, Metric::Kind>, 10> metric_kinds{{
    {"rms", Metric::Kind::rms},
    {"mean", Metric::Kind::mean},
    {"maximum", Metric::Kind::maximum},
    {"minimum", Metric::Kind::minimum},
    {"peak", Metric::Kind::peak},
    {"final", Metric::Kind::final},
    {"settling_time", Metric::Kind::settling_time},
    {"overshoot", Metric::Kind::overshoot},
    {"percentile", Metric::Kind::percentile},
    {"first_violation", Metric::Kind::first_violation},
}};

void reject_what_does_not_belong(const Reader& reader, const Metric& metric, const Value& body) {
  const FileShape shape = metric_shape(metric.kind);
  for (const FileShape::Key& key : shape.keys)
    if (key.is_required && !body.find(key.name))
      reader.error(body, fmt::format("\"{}\" of \"{}\" is missing", key.name, to_name(metric.kind)));
  reject_unknown(reader, body, shape, fmt::format("\"{}\"", to_name(metric.kind)));
}

/// Reads the numbers of a metric. What has a unit of its own is compared with the signal later.
class MetricNumbers {
 public:
  MetricNumbers(const Reader& reader, const Value& body, Metric& metric)
      : reader_(reader), body_(body), metric_(metric) {}

  /// In `unit`.
  void in(std::string_view unit, double& to, std::string_view key) const {
    if (const auto number = find(key, -Reader::infinity))
      to = in_unit(*number, *parse_unit(unit), quoted(key), reader_).value_or(to);
  }
  /// In SI, of the signal.
  void of_signal(double& to, std::string_view key, double low = -Reader::infinity) const {
    keep(to, key, low, true);
  }
  /// In the unit of the result.
  void of_result(double& to, std::string_view key) const {
    if (!metric_.unit.empty()) return in(metric_.unit, to, key);
    keep(to, key, -Reader::infinity, false);
  }

 private:
  static std::string quoted(std::string_view key) { return fmt::format("\"{}\"", key); }
  std::optional<StatedNumber> find(std::string_view key, double low) const {
    const Value::Member* member = body_.find(key);
    return member ? stated_number(member->value, quoted(key), reader_, low) : std::nullopt;
  }
  void keep(double& to, std::string_view key, double low, bool is_of_signal) const {
    const auto number = find(key, low);
    if (!number) return;
    to = number->as_given();
    if (number->unit)
      metric_.stated.push_back({std::string(key), *number->at.unit, is_of_signal, number->at.place});
  }

  const Reader& reader_;
  const Value& body_;
  Metric& metric_;
};

std::optional<Metric> read_metric(const Reader& reader, const Value::Member& member) {
  Metric metric;
  metric.name = member.name, metric.place = member.place, metric.pointer = member.value.place.pointer();
  reader.check_name(member, "a metric");
  const Value& body = member.value;
  if (!reader.expect(body, Value::Kind::object, "a metric", "{\"rms\": \"error.sum\"}")) return {};
  int kinds = 0;
  for (const auto& [name, kind] : metric_kinds)
    if (body.find(name)) {
      ++kinds;
      metric.kind = kind;
      metric.signal = reader.text(body, name);
    }
  if (kinds != 1) {
    auto& p = reader.error(member, kinds ? "a metric measures one thing" : "the metric measures nothing");
    std::vector<std::string> names;
    for (const auto& [name, kind] : metric_kinds) names.emplace_back(name);
    p.expected = fmt::format("one of {}", fmt::join(names, ", "));
    for (const Value::Member& key : body.members)
      if (const std::string near = nearest_name(key.name, names); kinds == 0 && !near.empty())
        p.found = fmt::format("\"{}\"", key.name), p.hint = fmt::format("did you mean \"{}\"?", near);
    return {};
  }
  reject_what_does_not_belong(reader, metric, body);
  if (body.find("unit") && reader.unit(body.find("unit")->value)) metric.unit = reader.text(body, "unit");
  const MetricNumbers numbers(reader, body, metric);
  numbers.in("s", metric.from, "from"), numbers.in("s", metric.to, "to");
  if (metric.from >= metric.to) reader.error(member, "\"from\" must lie before \"to\"");
  numbers.of_signal(metric.target, "target");
  numbers.of_signal(metric.band, "band", 0), numbers.of_signal(metric.threshold, "threshold", 0);
  metric.percent = reader.optional_number(body, "percent", 95, 0, 100);
  numbers.of_result(metric.least, "least"), numbers.of_result(metric.most, "most");
  return metric;
}

}  // namespace

std::vector<Metric> read_metrics(const Reader& reader, const Value& file) {
  const Value::Member* list = file.find("metrics");
  if (!list) {
    reader.error(file, "the sweep measures nothing").expected =
        "\"metrics\": {\"tracking\": {\"rms\": \"error.sum\"}}";
    return {};
  }
  const std::string expected = "an object: name → {\"rms\": \"error.sum\"}";
  if (!reader.expect(list->value, Value::Kind::object, "\"metrics\"", expected)) return {};
  if (list->value.members.empty()) reader.error(list->value, "the sweep measures nothing");
  std::vector<Metric> metrics;
  for (const Value::Member& member : list->value.members)
    if (auto metric = read_metric(reader, member)) metrics.push_back(std::move(*metric));
  return metrics;
}

std::string_view to_name(Metric::Kind kind) {
  for (const auto& [name, candidate] : metric_kinds)
    if (candidate == kind) return name;
  return "?";
}

}  // namespace loopwright
