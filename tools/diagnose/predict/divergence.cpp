#include "tools/diagnose/predict/divergence.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

std::string shown_number(const Plan& plan, Number number, double value) {
  const std::optional<Unit> unit = plan.unit_of(number);
  return fmt::format("{} = {}", plan.name_of(number), shown(value, unit ? to_string(unit->in_si()) : ""));
}

/// The first block that makes no number of numbers, and what it reads.
std::string told_culprit(const Plan& plan, std::span<const double> numbers) {
  const auto is_finite = [&](Number number) { return number < 0 || std::isfinite(numbers[size_t(number)]); };
  for (const Plan::Block& block : plan.blocks) {
    if (block.outputs.empty() || is_finite(block.outputs[0])) continue;
    std::vector<std::string> read;
    bool are_finite = true;
    for (const auto& port : block.inputs)
      for (const Number number : port) {
        are_finite &= is_finite(number);
        if (number >= 0 && are_finite) read.push_back(shown_number(plan, number, numbers[size_t(number)]));
      }
    if (!are_finite) continue;
    return fmt::format("{} is {} there{}", plan.name_of(block.outputs[0]),
                       numbers[size_t(block.outputs[0])],
                       read.empty() ? "" : fmt::format(", from {}", fmt::join(read, ", ")));
  }
  return "within the sample that follows, a state or a block is no number any more";
}

}  // namespace

std::string told_divergence(SiteFilter& filter) {
  SiteModel& model = filter.model();
  const SiteFilter::End& end = filter.end();
  if (end.states.size() < model.states()) return "";
  std::vector<double> numbers(size_t(model.numbers()));
  const double time = model.record().time[end.row];
  model.look(end.row, time, end.states.data(), numbers.data());
  std::vector<std::string> states;
  for (int i = 0; i < model.states(); ++i)
    states.push_back(shown_number(model.plan(), model.plan().signals + i, end.states[i]));
  return fmt::format("at {:.6g} s (row {}), with {}: {}", time, end.row + 1, fmt::join(states, ", "),
                     told_culprit(model.plan(), numbers));
}

}  // namespace loopwright::diagnosis
