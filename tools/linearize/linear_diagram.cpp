#include "tools/linearize/linear_diagram.h"
#include "engine/run/require_finished.h"
#include "models/real/whole.h"
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace loopwright {

/// Blocks that may stand still have no slopes that hold for small motions around every instant.
static void refuse_gates(const Plan& plan) {
  if (plan.gates.empty()) return;
  Problems problems;
  for (const Plan::Gate& gate : plan.gates)
    problems
        .error(gate.place, gate.place.pointer(), plan.blocks[size_t(gate.block)].path,
               "a subdiagram that does not always run cannot be linearized")
        .hint = fmt::format("without \"{}\" it always runs", gate.key);
  throw InputError(std::move(problems));
}

LinearDiagram linearize(const Run<double>& run) {
  const Plan& plan = run.plan();
  refuse_gates(plan);
  LinearDiagram diagram;
  diagram.plan = &plan;
  diagram.time = run.now().time;
  for (int b = 0; b < int(plan.blocks.size()); ++b)
    diagram.blocks.push_back(linearize_block(run, b, diagram.notes));
  for (Number n = 0; n < plan.signals + plan.states; ++n) diagram.operating_point.push_back(run.number(n));
  return diagram;
}

LinearDiagram linearize_at_start(const Plan& plan) {
  Run<double> run(plan);
  run.evaluate(run.due(), true);
  run.accept();
  if (run.failed())
    throw std::runtime_error("\"" + plan.blocks[size_t(run.fault().block)].path +
                             "\" stopped the run at its start: " + run.fault().reason);
  return linearize(run);
}

LinearDiagram linearize_at(const Plan& plan, double time, const RunOptions& options) {
  Plan until = plan;
  until.stop_tick =
      whole_between<int64_t>(std::round(time / plan.clock.base.value()), plan.start_tick, INT64_MAX);
  LinearDiagram diagram;
  RunOptions with_stop = options;
  with_stop.at_stop = [&](Run<double>& run) { diagram = linearize(run); };
  const RunResult result = simulate(until, with_stop);
  require_finished(result);
  diagram.plan = &plan;
  return diagram;
}

bool has_samples(const LinearDiagram& diagram) { return !diagram.plan->rates.empty(); }

void refuse_other_sample_time(const LinearDiagram& diagram, double sample_time) {
  constexpr double rounding = 1e-9;  // of decimal fractions of a second
  std::string rates;
  for (const Rate& rate : diagram.plan->rates) {
    const double period = diagram.plan->clock.time(rate.period);
    if (std::abs(sample_time - period) <= rounding * period) return;
    rates += fmt::format("{}{:g} s", rates.empty() ? "" : ", ", period);
  }
  if (rates.empty() || sample_time == 0) return;
  Problems problems;
  auto& p = problems.error({}, "", "",
                           "the diagram has sample times of its own, which --sample-time cannot change");
  p.expected = rates, p.found = fmt::format("{:g} s", sample_time);
  p.hint = "--continuous leaves the sampled parts out; --set changes the sample time of a block";
  throw InputError(std::move(problems));
}

}  // namespace loopwright
