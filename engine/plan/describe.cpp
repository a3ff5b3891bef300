#include <fmt/format.h>
#include "engine/plan/plan.h"

namespace loopwright {
namespace {

std::string rate_text(const Plan& plan, const Plan::Entry& entry) {
  switch (entry.rate.kind) {
    case Rate::Kind::constant:
      return "once";
    case Rate::Kind::continuous:
      return entry.in_stages ? "continuous" : entry.for_events ? "every step" : "when read";
    case Rate::Kind::sampled:
      break;
  }
  const std::string period = fmt::format("{:g} s", plan.clock.time(entry.rate.period));
  return entry.rate.offset ? fmt::format("{} + {:g} s", period, plan.clock.time(entry.rate.offset)) : period;
}

std::string entry_text(const Plan& plan, const Plan::Entry& entry) {
  if (entry.kind == Plan::Entry::Kind::algebraic_loop) {
    const Plan::AlgebraicLoop& loop = plan.algebraic_loops[size_t(entry.block)];
    return fmt::format("algebraic loop of {} solved for {} numbers:{}", loop.entries.size(),
                       loop.tears.size(), loop.text);
  }
  const Plan::Block& block = plan.blocks[size_t(entry.block)];
  if (entry.kind == Plan::Entry::Kind::decide) return fmt::format("{} decides", block.path);
  std::string ports;
  for (const PortInfo& port : block.type->info.outputs)
    if (port.group == entry.group) ports += fmt::format("{}{}", ports.empty() ? "" : ", ", port.name);
  return fmt::format("{} ({}) {}", block.path, block.type->info.type, ports);
}

}  // namespace

std::string describe(const Plan& plan) {
  const MethodFacts& method = facts(plan.method);
  std::string text = fmt::format("{}\n", plan.title.empty() ? "untitled" : plan.title);
  text += fmt::format(
      "  plan {}   {} blocks   {} signals   {} states   {} rates   {} crossings   {} algebraic loops\n",
      plan.hash, plan.blocks.size(), plan.signals, plan.states, plan.rates.size(), plan.crossings.size(),
      plan.algebraic_loops.size());
  text += fmt::format("  tick {}/{} s   from {:g} to {:g} s   {}", plan.clock.base.numerator,
                      plan.clock.base.denominator, plan.clock.time(plan.start_tick),
                      plan.clock.time(plan.stop_tick), method.name);
  if (method.fixed_step)
    text += fmt::format(" at {:g} s", plan.clock.time(plan.step_ticks));
  else
    text += fmt::format(", relative tolerance {:g}, absolute {:g}", plan.relative_tolerance,
                        plan.absolute_tolerance);
  text += fmt::format("   a row every {:g} s\n\nrates\n", plan.clock.time(plan.record_ticks));
  for (const Rate& rate : plan.rates)
    text += fmt::format("  every {} ticks from tick {}: {:g} s\n", rate.period, rate.offset,
                        plan.clock.time(rate.period));
  if (plan.rates.empty()) text += "  none: nothing is sampled\n";
  text += "\norder\n";
  for (size_t i = 0; i < plan.order.size(); ++i)
    text += fmt::format("  {:4}  {:<18} {}\n", i + 1, rate_text(plan, plan.order[i]),
                        entry_text(plan, plan.order[i]));
  text += "\nstates\n";
  for (const Plan::Block& block : plan.blocks) {
    if (block.states == 0) continue;
    std::string names;
    for (const PortInfo& port : block.type->info.outputs)
      if (port.state >= 0) names += fmt::format("{}{}", names.empty() ? "" : ", ", port.name);
    text += fmt::format("  {} ({}): {}{}\n", block.path, block.type->info.type, block.states,
                        names.empty() ? "" : " (" + names + ")");
  }
  if (plan.states == 0) text += "  none: nothing is continuous\n";
  return text;
}

}  // namespace loopwright
