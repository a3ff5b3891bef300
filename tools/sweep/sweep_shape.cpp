#include "tools/sweep/sweep_shape.h"

namespace loopwright {

using namespace shapes;

namespace {

constexpr double most_values = 1e6, most_kept = 1e4;
constexpr double largest_seed = 9007199254740992.0;  // 2^53: every integer up to this is a double

FileShape alternatives_of_axis() {
  const auto way = [](std::string_view name, FileShape shape, std::string sentence) {
    return object({required(name, std::move(shape), std::move(sentence)),
                   optional("unit", text(), "Of the numbers; they may state their own")});
  };
  return either({way("values", list(stated(), 1), "One run for each value"),
                 way("linear", grid_shape(), "Values at equal distances"),
                 way("logarithmic", grid_shape(), "Values at equal ratios"),
                 way("uniform", distribution_shape(), "Sampled, evenly distributed"),
                 way("log_uniform", distribution_shape(), "Sampled, with an evenly distributed logarithm"),
                 way("normal", normal_shape(), "Sampled, normally distributed"),
                 way("variants", list(text(), 1), "One run for each variant of the block")});
}

FileShape metrics_shape() {
  std::vector<FileShape> kinds;
  for (int kind = 0; kind <= int(Metric::Kind::first_violation); ++kind)
    kinds.push_back(metric_shape(Metric::Kind(kind)));
  return either(std::move(kinds));
}

}  // namespace

FileShape grid_shape() {
  return object(
      {required("from", stated()), required("to", stated()), required("count", whole(2, most_values))});
}
FileShape distribution_shape() { return object({required("from", stated()), required("to", stated())}); }
FileShape normal_shape() { return object({required("mean", stated()), required("deviation", stated())}); }
FileShape axis_shape() { return alternatives_of_axis(); }

FileShape samples_shape() {
  return object({required("count", whole(1, most_runs), "How many samples"),
                 optional("method", choice({"random", "latin_hypercube", "sobol", "saltelli"}))});
}
FileShape worst_shape() {
  return object({required("worst", whole(1, most_kept), "How many runs"),
                 required("of", text(), "The metric whose largest values are kept")});
}
FileShape selected_shape() {
  return object({required("runs", list(whole(0, most_runs)), "Numbers of runs")});
}

FileShape metric_shape(Metric::Kind kind) {
  using Kind = Metric::Kind;
  std::vector<FileShape::Key> keys = {
      required(to_name(kind), text(), "A signal, or \"=\" and an expression over signals"),
      optional("unit", text(), "Of the result, and of its limits"),
      optional("from", stated(), "Time of the first row [s]"),
      optional("to", stated(), "Time of the last row [s]"),
      optional("least", stated(), "Below it, the run misses its limit"),
      optional("most", stated(), "Above it, the run misses its limit")};
  if (kind == Kind::settling_time || kind == Kind::overshoot)
    keys.push_back(required("target", stated(), "The value that the signal is to reach"));
  if (kind == Kind::settling_time)
    keys.push_back(required("band", stated(0), "Within it the signal has settled"));
  if (kind == Kind::percentile) keys.push_back(optional("percent", number(0, 100)));
  if (kind == Kind::first_violation) keys.push_back(required("threshold", stated(0)));
  return object(std::move(keys));
}

FileShape sweep_shape() {
  return file({optional("title", text()), optional("description", text()),
               required("diagram", text(1), "Its path, relative to this file"),
               optional("set", by_name(anything()), "Values for all runs, as with --set: path → value"),
               optional("variants", by_name(text()), "Variants for all runs: block → name"),
               optional("seed", whole(0, largest_seed), "Of the samples"),
               required("axes", by_name(axis_shape(), 1), "What differs between the runs: path → values"),
               optional("paired", list(list(text())), "Axes that step together"),
               optional("samples", samples_shape(), "Of axes with a distribution"),
               required("metrics", by_name(metrics_shape(), 1), "What is measured in each run"),
               optional("keep", either({choice({"all", "failed"}), worst_shape(), selected_shape()}),
                        "The runs whose signals are written")});
}

}  // namespace loopwright
