#include "tests/engine/lanes/lane_testing.h"
#include <fmt/format.h>
#include <cmath>
#include <cstring>
#include "engine/run/fixed_step.h"

namespace loopwright::testing {

std::shared_ptr<const Plan> fixed_step_plan(const std::string& path) {
  Problems problems;
  const auto loaded = load_diagram(path, {}, problems);
  if (!loaded) throw InputError(std::move(problems));
  Diagram diagram = *loaded;
  SolverSettings& solver = diagram.solver;
  if (const auto method = method_from_name(solver.method.value); method && !is_fixed_step(*method)) {
    // Of a run that takes hours, a hundred thousand steps suffice. Powers of ten divide the sample times.
    const double step_of_long_runs = std::pow(10, std::ceil(std::log10(solver.stop.value / 1e5)));
    solver.method.value = "rk4";
    solver.step.value = std::fmax(1e-4, step_of_long_runs), solver.step.is_given = true;
    solver.relative_tolerance = {}, solver.absolute_tolerance = {}, solver.maximum_step = {};
  }
  auto plan = compile(diagram, problems);
  if (!plan) throw InputError(std::move(problems));
  return plan;
}

double number(const LaneRun& run, Number number, int lane) {
  std::vector<double> lanes(size_t(run.lanes()));
  run.read({&number, 1}, lanes.data());
  return lanes[size_t(lane)];
}

bool set_parameter(LaneRun& run, std::string_view path, int lane, double value) {
  double* const found = run.parameter(path, lane);
  if (found) *found = value;
  return found != nullptr;
}

double TunedParameter::in_lane(int lane) const {
  // The lane comes first, because the last hashed value hardly affects the upper bits.
  const uint64_t bits = ContentHash().add(std::to_string(lane)).add(path).value();
  const double share = double(bits >> 11) * 0x1p-52 - 1.0;  // in [-1, 1)
  const double tuned = value == 0 ? 0.01 * share : value * (1 + 0.03 * share);
  const double inside = std::min(std::max(tuned, low), high);
  return inside == low && low_is_open ? value : inside;
}

static void add_tunable(Run<double>& run, const std::string& path, const ParameterInfo& info,
                        std::vector<TunedParameter>& found) {
  if (const double* number = run.parameter(path))
    found.push_back({path, *number, info.low, info.high, info.low_is_open});
  for (const ParameterInfo& field : info.fields)
    if (info.kind == ParameterKind::object)
      add_tunable(run, fmt::format("{}.{}", path, field.name), field, found);
  if (info.kind != ParameterKind::list) return;
  for (size_t i = 0, before = found.size();; ++i, before = found.size()) {
    add_tunable(run, fmt::format("{}.{}", path, i), info.element[0], found);
    if (found.size() == before) return;
  }
}

std::vector<TunedParameter> tunable_parameters(const Plan& plan) {
  std::vector<TunedParameter> found;
  Run<double> run(plan);
  for (const Plan::Block& block : plan.blocks)
    for (const ParameterInfo& info : block.type->info.parameters)
      add_tunable(run, fmt::format("{}.{}", block.path, info.name), info, found);
  return found;
}

Rows scalar_rows(const Plan& plan, const std::vector<TunedParameter>& parameters, int lane) {
  Run<double> run(plan);
  for (const TunedParameter& parameter : parameters) *run.parameter(parameter.path) = parameter.in_lane(lane);
  run.reset({plan.seed, lane});
  Rows rows;
  run_fixed_steps(
      run, run.now().tick,
      [&] {
        rows.values.push_back(run.now().time);
        for (const Plan::Logged& logged : plan.log) rows.values.push_back(run.number(logged.number));
      },
      [&](bool) { return !run.failed(); });
  rows.failed = run.failed() != 0;
  if (rows.failed) rows.failed_at = run.now().time;
  return rows;
}

std::vector<Rows> lane_rows(const Plan& plan, const std::vector<TunedParameter>& parameters,
                            InstructionSet set, int arenas) {
  const auto run = make_lane_run(plan, set, arenas);
  const int lanes = run->lanes();
  for (const TunedParameter& parameter : parameters)
    for (int lane = 0; lane < lanes; ++lane)
      if (!set_parameter(*run, parameter.path, lane, parameter.in_lane(lane)))
        ADD_FAILURE() << parameter.path << " cannot be tuned on lanes";
  run->reset({plan.seed, 0});
  std::vector<Rows> rows(static_cast<size_t>(lanes));
  std::vector<Number> logged;
  for (const Plan::Logged& l : plan.log) logged.push_back(l.number);
  std::vector<double> values(logged.size() * rows.size());
  run->run([&](double time) {
    run->read(logged, values.data());
    for (int lane = 0; lane < lanes; ++lane) {
      if (run->failed() >> lane & 1) continue;
      auto& to = rows[size_t(lane)].values;
      to.push_back(time);
      for (size_t i = 0; i < logged.size(); ++i) to.push_back(values[i * rows.size() + size_t(lane)]);
    }
    return true;
  });
  for (int lane = 0; lane < lanes; ++lane) {
    rows[size_t(lane)].failed = run->failed() >> lane & 1;
    rows[size_t(lane)].failed_at = run->failure(lane).time;
  }
  return rows;
}

std::string difference(const Plan& plan, const Rows& scalar, const Rows& lane) {
  if (scalar.failed != lane.failed || scalar.failed_at != lane.failed_at)
    return fmt::format("scalar failed: {} at {} s; lane: {} at {} s", scalar.failed, scalar.failed_at,
                       lane.failed, lane.failed_at);
  if (scalar.values.size() != lane.values.size())
    return fmt::format("{} numbers, {} on the lane", scalar.values.size(), lane.values.size());
  if (std::memcmp(scalar.values.data(), lane.values.data(), scalar.values.size() * sizeof(double)) == 0)
    return "";
  const size_t width = plan.log.size() + 1;
  for (size_t i = 0; i < scalar.values.size(); ++i) {
    const double a = scalar.values[i], b = lane.values[i];
    if (std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b))) continue;
    return fmt::format("{} at t = {} s: {} ({:a}), {} ({:a}) on the lane",
                       i % width ? plan.log[i % width - 1].name : "time", scalar.values[i / width * width], a,
                       a, b, b);
  }
  return "";
}

}  // namespace loopwright::testing
