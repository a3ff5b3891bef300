#include "tools/draw/signal_rates.h"
#include <algorithm>
#include <fmt/format.h>
#include <tuple>
#include "engine/plan/signal_rates.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

/// Orders rates as the legend shows them.
auto rank(const Rate& rate) {
  const int kind = rate.kind == Rate::Kind::continuous ? 0 : rate.kind == Rate::Kind::sampled ? 1 : 2;
  return kind == 1 ? std::tuple(kind, rate.period, rate.offset) : std::tuple(kind, int64_t(0), int64_t(0));
}

std::string to_name(const Rate& rate, const Plan& plan) {
  if (rate.kind == Rate::Kind::continuous) return "continuous";
  if (rate.kind == Rate::Kind::constant) return "constant";
  const auto seconds = [&](int64_t ticks) {
    const report::Quantity time = report::engineering(plan.clock.time(ticks), "s");
    return time.value + " " + time.unit;
  };
  return rate.offset == 0 ? seconds(rate.period)
                          : fmt::format("{}, {} later", seconds(rate.period), seconds(rate.offset));
}

}  // namespace

SignalRates::SignalRates(const Plan& plan) {
  const std::vector<Rate> rates = rates_of_signals(plan);
  std::vector<Rate> distinct = rates;
  std::ranges::sort(distinct, {}, rank);
  distinct.erase(std::ranges::unique(distinct, {}, rank).begin(), distinct.end());
  for (const Rate& rate : distinct) names_.push_back(to_name(rate, plan));
  for (const Rate& rate : rates)
    of_number_.push_back(int(std::ranges::lower_bound(distinct, rank(rate), {}, rank) - distinct.begin()));
}

int SignalRates::index_of(Number number) const {
  return number >= 0 && size_t(number) < of_number_.size() ? of_number_[size_t(number)] : -1;
}

}  // namespace loopwright
