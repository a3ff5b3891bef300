#include "tools/sweep/lane_group.h"
#include <fmt/format.h>
#include <cmath>
#include "engine/run/simulation.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright {
namespace {

RunRecord failure(int64_t run, size_t metrics, double time, std::string reason) {
  return {run, true, time, std::vector<double>(metrics, std::nan("")), std::move(reason)};
}

/// The plan with every observed signal in its recording.
Plan with_log(const Plan& plan, const std::vector<Number>& numbers) {
  Plan more = plan;
  for (const Number n : numbers) {
    Plan::Logged logged{};
    logged.name = fmt::format("observed {}", n);
    logged.number = n;
    more.log.push_back(logged);
  }
  return more;
}

}  // namespace

LaneGroup::LaneGroup(const SweepPlan& plan, std::optional<InstructionSet> set)
    : plan_(plan), set_(set.value_or(widest_instruction_set())) {}

void LaneGroup::enter(int64_t world) {
  if (world == world_) return;
  world_ = world;
  const World& here = plan_.world(world);
  run_.reset(), metrics_.reset(), parameters_.clear();
  if (!here.lanes_forbidden.empty()) return;
  const int lanes = lanes_in_arena(set_);
  run_ = make_lane_run(*here.plan, set_, lanes == 1 ? 1 : int(runs_in_block(plan_.design())) / lanes);
  metrics_ = std::make_unique<MetricBank>(plan_.sweep(), here.observed, run_->lanes());
  for (const std::string& path : here.tuned)
    for (int lane = 0; lane < run_->lanes(); ++lane) parameters_.push_back(run_->parameter(path, lane));
  values_.resize(here.observed.numbers.size() * size_t(run_->lanes()));
}

std::vector<RunRecord> LaneGroup::make(int64_t first, int64_t end) {
  std::vector<RunRecord> records;
  enter(first / plan_.design().runs_in_world());
  while (first < end) {
    const int64_t next = run_ ? std::min(end, first + run_->lanes()) : first + 1;
    if (run_)
      make_on_lanes(first, next, records);
    else
      records.push_back(make_alone(plan_, plan_.options(first), first));
    first = next;
  }
  return records;
}

/// Lanes beyond `end` repeat the last run; their results are ignored.
void LaneGroup::make_on_lanes(int64_t first, int64_t end, std::vector<RunRecord>& records) {
  const World& world = plan_.world(world_);
  const int lanes = run_->lanes();
  std::vector<std::string> refused(size_t(end - first));
  std::vector<double> tuned;
  for (int lane = 0; lane < lanes; ++lane) {
    if (first + lane < end) try {
        tuned = plan_.tuned(first + lane);
      } catch (const InputError& error) {
        refused[size_t(lane)] = error.problems.list().front().message;
      }
    for (size_t i = 0; i < tuned.size(); ++i) *parameters_[i * size_t(lanes) + size_t(lane)] = tuned[i];
  }
  metrics_->reset();
  run_->reset({world.plan->seed, first});
  run_->run([&](double time) {
    run_->read(world.observed.numbers, values_.data());
    metrics_->add(time, values_.data());
    return true;
  });
  for (int64_t run = first; run < end; ++run) {
    const int lane = int(run - first);
    const size_t metrics = plan_.sweep().metrics.size();
    if (!refused[size_t(lane)].empty())
      records.push_back(
          failure(run, metrics, 0, "the diagram refuses its parameters: " + refused[size_t(lane)]));
    else if (run_->failed() >> lane & 1)
      records.push_back(
          failure(run, metrics, run_->failure(lane).time, to_text(run_->failure(lane), *world.plan)));
    else
      records.push_back(
          {run, false, world.plan->clock.time(world.plan->stop_tick), metrics_->results(lane), ""});
  }
}

RunRecord make_alone(const SweepPlan& sweep_plan, const LoadOptions& options, int64_t run) {
  const Sweep& sweep = sweep_plan.sweep();
  try {
    const auto loaded = sweep_plan.load(options);
    Problems problems;
    const Observed observed = observe(sweep, *loaded, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    const Plan plan = with_log(*loaded, observed.numbers);
    RunOptions run_options;
    run_options.run = run;
    const RunResult result = simulate(plan, run_options);
    if (result.status != RunStatus::finished)
      return failure(run, sweep.metrics.size(), result.time, result.message);
    MetricBank metrics(sweep, observed, 1);
    metrics.reset();
    const auto& columns = result.recording.columns;
    std::vector<double> row(observed.numbers.size());
    for (size_t r = 0; r < columns[0].values.size(); ++r) {
      for (size_t i = 0; i < row.size(); ++i) row[i] = columns[1 + loaded->log.size() + i].values[r];
      metrics.add(columns[0].values[r], row.data());
    }
    return {run, false, result.time, metrics.results(0), ""};
  } catch (const InputError& error) {
    return failure(run, sweep.metrics.size(), 0,
                   "the diagram refuses its parameters: " + error.problems.list().front().message);
  }
}

}  // namespace loopwright
