#include "tools/run/limits.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace loopwright {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> limited_outputs{
    {{"ContinuousPidController", "command"},
     {"ContinuousPiController", "command"},
     {"DiscreteIntegrator", "y"},
     {"Integrator", "y"},
     {"PidController", "command"},
     {"Saturation", "y"},
     {"ScheduledPidController", "command"}}};

/// As the block has it, in SI: each element of a vector may have its own.
double bound(const Plan::Block& block, std::string_view name) {
  return *block.type->kernels.tunable(const_cast<void*>(block.value.get()),
                                      name);  // finds it, changes nothing
}

Number output_of(const Plan::Block& block, std::string_view name) {
  const auto& outputs = block.type->info.outputs;
  return block.outputs[size_t(std::ranges::find(outputs, name, &PortInfo::name) - outputs.begin())];
}

/// How many columns may be recorded in addition to the log.
size_t most_columns(const Plan& plan) {
  constexpr double most_bytes = 256e6;
  const double rows =
      double(plan.stop_tick - plan.start_tick) / double(std::max<int64_t>(plan.record_ticks, 1));
  return size_t(most_bytes / double(sizeof(double)) / (rows + 2));
}

}  // namespace

std::string_view limited_output(std::string_view type) {
  for (const auto& [name, output] : limited_outputs)
    if (name == type) return output;
  return {};
}

WatchedLimits::WatchedLimits(const Plan& plan) : plan_(plan), columns_(plan.log.size() + 1) {
  const size_t most = most_columns(plan);
  std::map<Number, size_t> recorded;  // the time is column 0
  for (size_t i = 0; i < plan.log.size(); ++i) recorded.try_emplace(plan.log[i].number, i + 1);
  for (const Plan::Block& block : plan.blocks) {
    const std::string_view output = limited_output(block.type->info.type);
    if (output.empty()) continue;
    const double low = bound(block, "low"), high = bound(block, "high");
    if (!std::isfinite(low) && !std::isfinite(high)) continue;
    const Number number = output_of(block, output);
    if (!recorded.contains(number) && plan_.log.size() + 1 - columns_ == most) {
      ++left_out_;
      continue;
    }
    const auto [column, is_new] = recorded.try_emplace(number, plan_.log.size() + 1);
    limits_.push_back({block.path, low, high, column->second});
    if (!is_new) continue;
    Plan::Logged watched;
    watched.name = plan.name_of(number);  // what a run that diverges there is told to have
    watched.number = number;
    plan_.log.push_back(std::move(watched));
  }
}

std::vector<TimeAtLimit> WatchedLimits::take(Recording& recording) const {
  std::vector<TimeAtLimit> shares;
  const std::vector<double>& time = recording.columns[0].values;
  const bool has_duration = time.size() > 1 && time.back() > time.front();
  for (const Limit& limit : limits_) {
    if (!has_duration) break;
    const std::vector<double>& values = recording.columns[limit.column].values;
    TimeAtLimit share{limit.block};
    // A row holds until the next one.
    for (size_t i = 0; i + 1 < time.size(); ++i) {
      const double part = (time[i + 1] - time[i]) / (time.back() - time.front());
      if (values[i] >= limit.high)
        share.high += part;
      else if (values[i] <= limit.low)
        share.low += part;
    }
    shares.push_back(std::move(share));
  }
  recording.columns.resize(columns_);
  return shares;
}

}  // namespace loopwright
