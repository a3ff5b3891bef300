#include "tools/compare/joined_bodies.h"
#include <algorithm>
#include <optional>
#include <vector>

namespace loopwright {
namespace {

/// The body that has this state, else the block that computes the number; -1: none.
int block_of(const Plan& plan, Number number) {
  if (!is_state(plan, number)) return number < 0 ? -1 : plan.source_of(number).first;
  const auto has_it = [&](const Plan::Block& block) {
    const int state = number - plan.signals;
    return state >= block.first_state && state < block.first_state + block.states;
  };
  return int(std::ranges::find_if(plan.blocks, has_it) - plan.blocks.begin());
}

/// The body of a state, and those that couplings without a ratio join to it.
std::vector<int> bodies_with(const Plan& plan, Number state) {
  std::vector<int> bodies{block_of(plan, state)};
  for (size_t known = 0; known != bodies.size();) {
    known = bodies.size();
    for (const Plan::Block& block : plan.blocks) {
      if (block.type->info.type != "ElasticCoupling" && block.type->info.type != "BacklashCoupling") continue;
      std::vector<int> ends;
      for (const auto& port : block.inputs)
        for (const Number number : port) ends.push_back(block_of(plan, number));
      const auto is_body = [&](int end) { return std::ranges::find(bodies, end) != bodies.end(); };
      if (std::ranges::none_of(ends, is_body)) continue;
      for (const int end : ends)
        if (end >= 0 && !is_body(end)) bodies.push_back(end);
    }
  }
  return bodies;
}

}  // namespace

void carry_along(const Plan& plan, Number position, Number velocity, double to_position, double to_velocity,
                 double* states) {
  const auto unit_of = [&](Number n) { return is_state(plan, n) ? plan.unit_of(n) : std::nullopt; };
  const std::optional<Unit> units[] = {unit_of(position), unit_of(velocity)};
  const auto now = [&](Number n) { return is_state(plan, n) ? states[n - plan.signals] : 0.0; };
  const double by[] = {to_position - now(position), to_velocity - now(velocity)};
  const Number of_axis = is_state(plan, position) ? position : velocity;
  if (!is_state(plan, of_axis)) return;
  for (const int body : bodies_with(plan, of_axis)) {
    const Plan::Block& block = plan.blocks[size_t(body)];
    for (int i = block.first_state; i < block.first_state + block.states; ++i)
      for (const int kind : {0, 1}) {
        const Number number = plan.signals + i;
        if (!units[kind] || number == position || number == velocity) continue;
        if (plan.unit_of(number) == units[kind]) states[i] += by[kind];
      }
  }
}

}  // namespace loopwright
