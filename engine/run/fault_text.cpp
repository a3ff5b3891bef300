#include "engine/run/fault_text.h"
#include <fmt/format.h>
#include "engine/run/algebraic_loop.h"

namespace loopwright {
namespace {

bool is_of_algebraic_loop(std::string_view reason) {
  return reason == loop_not_solved || reason == loop_is_singular;
}

}  // namespace

std::string fault_text(const Plan& plan, const FaultReport& fault, double time) {
  std::string text =
      fmt::format("\"{}\" stopped the run at t = {:g} s: {}",
                  fault.block < 0 ? "?" : plan.blocks[size_t(fault.block)].path, time, fault.reason);
  if (!is_of_algebraic_loop(fault.reason)) return text;
  for (const Plan::AlgebraicLoop& loop : plan.algebraic_loops)
    if (loop.entries.front().block == fault.block) return text + loop.text;
  return text;
}

}  // namespace loopwright
