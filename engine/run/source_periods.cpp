#include "engine/run/source_periods.h"
#include <fmt/format.h>
#include "engine/solve/method.h"

namespace loopwright {
namespace {

constexpr double steps_in_period = 4;    // a crossing is sampled four times in each, so 16 times per period
constexpr double samples_in_period = 2;  // fewer show an aliased frequency

/// s; infinity: none.
double shortest_period(const Run<double>& run, size_t block) {
  const BlockInfo& info = run.plan().blocks[block].type->info;
  return info.shortest_period ? info.shortest_period(run.call(int(block)).block) : infinity;
}

}  // namespace

double default_maximum_step(const Run<double>& run) {
  const Plan& plan = run.plan();
  double longest = plan.states > 0 ? infinity : plan.typical_step;
  for (size_t b = 0; b < plan.blocks.size(); ++b)
    if (plan.blocks[b].period == 0) longest = std::min(longest, shortest_period(run, b) / steps_in_period);
  return longest;
}

std::string aliasing_warning(const Run<double>& run) {
  const Plan& plan = run.plan();
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    const Plan::Block& block = plan.blocks[b];
    const double period = shortest_period(run, b);
    const bool is_stepped = is_fixed_step(plan.method) && plan.steps_between_samples;
    const double seen_every = block.period > 0 ? block.sample_time
                              : is_stepped     ? plan.clock.time(plan.step_ticks)
                                               : 0;
    if (seen_every * samples_in_period <= period) continue;
    return fmt::format(
        "\"{}\" has a period of {:.3g} s, but is looked at every {:.3g} s only: what is seen is another "
        "frequency; take a shorter {}",
        block.path, period, seen_every,
        block.period > 0 ? "\"sample_time\"" : "\"step\", or a variable-step method");
  }
  return {};
}

}  // namespace loopwright
