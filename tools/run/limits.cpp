#include "tools/run/limits.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace loopwright {
namespace {

/// The number at the start of an effective value, "10 V"; infinity if it is none.
double bound(const std::map<std::string_view, std::string_view>& settings, const std::string& name) {
  double value = std::numeric_limits<double>::infinity();
  const auto found = settings.find(name);
  if (found != settings.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
  return value;
}

bool has_limits(const BlockInfo& info) {
  const auto has = [&](std::string_view name) {
    return std::ranges::find(info.parameters, name, &ParameterInfo::name) != info.parameters.end();
  };
  return has("low") && has("high") && info.type != "DeadZone" && !info.outputs.empty();
}

}  // namespace

WatchedLimits::WatchedLimits(const Plan& plan) : plan_(plan) {
  constexpr size_t most = 32;
  const std::map<std::string_view, std::string_view> settings(plan.parameters.begin(), plan.parameters.end());
  for (const Plan::Block& block : plan.blocks) {
    if (!has_limits(block.type->info) || limits_.size() == most || block.output_lengths[0] != 1) continue;
    const Limit limit{block.path, bound(settings, block.path + ".low"),
                      bound(settings, block.path + ".high")};
    if (!std::isfinite(limit.low) && !std::isfinite(limit.high)) continue;
    Plan::Logged watched;
    watched.name = "at a limit: " + block.path;
    watched.number = block.outputs[0];
    plan_.log.push_back(std::move(watched));
    limits_.push_back(limit);
  }
}

std::vector<TimeAtLimit> WatchedLimits::take(Recording& recording) const {
  std::vector<TimeAtLimit> shares;
  const size_t first = recording.columns.size() - limits_.size(), rows = recording.rows();
  for (size_t k = 0; k < limits_.size() && rows > 1; ++k) {
    const std::vector<double>&time = recording.columns[0].values,
          &values = recording.columns[first + k].values;
    TimeAtLimit share{limits_[k].block};
    // A row holds until the next one.
    for (size_t i = 0; i + 1 < rows; ++i) {
      const double part = (time[i + 1] - time[i]) / (time.back() - time.front());
      if (values[i] >= limits_[k].high)
        share.high += part;
      else if (std::isfinite(limits_[k].low) && values[i] <= limits_[k].low)
        share.low += part;
    }
    shares.push_back(share);
  }
  recording.columns.resize(first);
  return shares;
}

}  // namespace loopwright
