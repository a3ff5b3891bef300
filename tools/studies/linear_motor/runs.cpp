#include "tools/studies/linear_motor/runs.h"
#include <fmt/format.h>
#include <cmath>
#include <stdexcept>
#include "engine/run/simulation.h"

namespace loopwright::paper {
namespace {

LoadOptions together(const LoadOptions& first, const LoadOptions& second) {
  LoadOptions both = first;
  both.set.insert(both.set.end(), second.set.begin(), second.set.end());
  both.variants.insert(second.variants.begin(), second.variants.end());
  return both;
}

Recording run_plan(const Plan& plan, int64_t run) {
  RunOptions options;
  options.run = run;
  RunResult result = simulate(plan, options);
  if (result.status != RunStatus::finished)
    throw std::runtime_error(fmt::format("{}: {}", plan.title, result.message));
  return std::move(result.recording);
}

}  // namespace

Condition paper_condition() { return {"paper", "The paper's motion", {}}; }

Condition held_out_condition() {
  return {"held_out", "Held-out motion", {.variants = {{"reference", "held_out"}}}};
}

std::vector<Condition> harder_conditions() {
  const auto held_out_and = [](std::string key, std::string title, LoadOptions changes) {
    return Condition{std::move(key), std::move(title), together(held_out_condition().changes, changes)};
  };
  return {
      held_out_and("payload2x", "Twice the mass", {.set = {{"payload", "0.2621 kg"}}}),
      held_out_and("delay1", "One sample more delay",
                   {.variants = {{"stage.latency", "one_sample"}, {"controller.latency", "one_sample"}}}),
      held_out_and("homing1mm", "Homing error of -1 mm", {.set = {{"homing_error", "-1 mm"}}}),
      held_out_and("homing1mm_ahead", "Homing error of +1 mm", {.set = {{"homing_error", "1 mm"}}}),
      held_out_and("homing3mm", "Homing error of -3 mm", {.set = {{"homing_error", "-3 mm"}}}),
      held_out_and("pitch", "Pole pitch 22.45 mm, not 22.5",
                   {.set = {{"stage.motor.pole_pitch", "22.45 mm"}}}),
      held_out_and(
          "cogging130", "Cogging 1.3 times as strong",
          {.set = {{"stage.motor.cogging", "=1.3*0.76"}, {"stage.motor.second_cogging", "=1.3*0.152"}}}),
  };
}

Condition payload_condition(double ratio) {
  return {fmt::format("payload{:g}", ratio),
          fmt::format("{:g} times the mass", 1 + ratio),
          {.set = {{"payload", fmt::format("{:.17g} kg", ratio * 0.2621)}}}};
}

Recording run_diagram(const std::string& diagram, const LoadOptions& changes, int64_t run) {
  return run_plan(*load_plan(diagram, changes), run);
}

Recording track(const Controller& controller, const Condition& condition, int64_t run) {
  return run_diagram(controller.diagram, together(controller.changes, condition.changes), run);
}

Spread spread_of(std::span<const double> values) {
  Spread spread;
  for (double value : values) spread.mean += value / double(values.size());
  for (double value : values) spread.deviation += (value - spread.mean) * (value - spread.mean);
  spread.deviation = values.size() > 1 ? std::sqrt(spread.deviation / double(values.size() - 1)) : 0;
  return spread;
}

double tracking_rmse(const Recording& recording) {
  return rms_between(recording, "error.sum", 0, motion_end_s - motion_start_s);
}

Spread tracking_rmse(const Controller& controller, const Condition& condition, int64_t first_run, int runs) {
  const auto plan = load_plan(controller.diagram, together(controller.changes, condition.changes));
  std::vector<double> values;
  for (int run = 0; run < runs; ++run) values.push_back(tracking_rmse(run_plan(*plan, first_run + run)));
  return spread_of(values);
}

std::span<const double> column(const Recording& recording, std::string_view name) {
  if (const Column* found = recording.find(name)) return found->values;
  throw std::runtime_error(fmt::format("the recording has no column \"{}\"", name));
}

double rms_between(const Recording& recording, std::string_view name, double from_s, double to_s) {
  const auto time = column(recording, "time"), values = column(recording, name);
  const double rounding = 1e-9;
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < time.size(); ++i) {
    const double since = time[i] - motion_start_s;
    if (since < from_s - rounding || since > to_s + rounding) continue;
    sum += values[i] * values[i];
    ++count;
  }
  return count ? std::sqrt(sum / double(count)) : 0;
}

}  // namespace loopwright::paper
