#include "engine/plan/signal_rates.h"

namespace loopwright {

std::vector<Rate> rates_of_signals(const Plan& plan) {
  std::vector<Rate> rates(size_t(plan.signals));  // constant unless the order computes them
  const auto mark = [&](const Plan::Entry& entry, const Rate& rate) {
    if (entry.kind != Plan::Entry::Kind::outputs) return;
    const Plan::Block& block = plan.blocks[size_t(entry.block)];
    for (size_t o = 0; o < block.outputs.size(); ++o)
      if (block.type->info.outputs[o].group == entry.group)
        for (int i = 0; i < block.output_lengths[o] && block.outputs[o] + i < plan.signals; ++i)
          rates[size_t(block.outputs[o] + i)] = rate;
  };
  for (const Plan::Entry& entry : plan.order) {
    if (entry.kind == Plan::Entry::Kind::algebraic_loop)
      for (const Plan::Entry& inner : plan.algebraic_loops[size_t(entry.block)].entries)
        mark(inner, entry.rate);
    else
      mark(entry, entry.rate);
  }
  rates.resize(size_t(plan.signals + plan.states), {Rate::Kind::continuous, 0, 0});
  return rates;
}

}  // namespace loopwright
