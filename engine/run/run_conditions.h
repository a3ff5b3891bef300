/// The calls of blocks in subdiagrams that do not always run.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

/// The call of an entry of the order. What is continuous is computed a last time at the instant at which it
/// is switched off: the signals that are then held are those of that instant, not of a stage of the step
/// before.
template <class Real> Call<Real> Run<Real>::conditional(const Plan::Entry& entry, Call<Real> call, At at) {
  if (plan_.gates.empty() || entry.kind == Plan::Entry::Kind::algebraic_loop) return call;
  const bool is_last = at == At::decision && entry.rate.kind == Rate::Kind::continuous;
  call = conditional(call, Conditional::Kind::compute, 0, is_last);
  const auto gate = std::ranges::find(plan_.gates, entry.block, &Plan::Gate::block);
  if (gate == plan_.gates.end() || entry.kind != Plan::Entry::Kind::outputs) return call;
  return gate_call(size_t(gate - plan_.gates.begin()), call);  // around its own condition
}

/// Any other call of a block.
template <class Real>
Call<Real> Run<Real>::conditional(Call<Real> call, typename Conditional::Kind kind, int numbers,
                                  bool is_last) {
  int gate = plan_.blocks[size_t(call.index)].gate;
  if (gate < 0) return call;
  typename Conditional::Gates gates;
  for (; gate >= 0; gate = plan_.gates[size_t(gate)].parent)
    gates.push_back(gates_[size_t(call.first_lane / width)][size_t(gate)].get());
  call.block =
      conditional_.emplace_back(std::make_unique<Conditional>(call, std::move(gates), is_last, kind, numbers))
          .get();
  call.step = &Conditional::step;
  return call;
}

/// The first call of a gate is the one that notes when it is switched; inside a step it is not switched.
template <class Real> Call<Real> Run<Real>::gate_call(size_t gate, Call<Real> call) {
  const size_t arena = size_t(call.first_lane / width);
  auto& own = gates_[arena][gate];
  if (own) return call;
  const auto number = [&](Number n) { return numbers_ + ptrdiff_t(arena) * stride_ + n; };
  std::vector<typename GateCall<Real>::Member> members;
  for (const int b : plan_.gates[gate].restarts) {
    const Plan::Block& block = plan_.blocks[size_t(b)];
    const auto inner = std::ranges::find(plan_.gates, b, &Plan::Gate::block);
    members.push_back({base_[arena][size_t(b)], &block.type->kernels, block.buffer_lengths.size(),
                       inner == plan_.gates.end() ? nullptr : number(inner->on)});
  }
  own = std::make_unique<GateCall<Real>>(call, number(plan_.gates[gate].on), std::move(members));
  call.block = own.get();
  call.step = &GateCall<Real>::step;
  return call;
}

}  // namespace loopwright
