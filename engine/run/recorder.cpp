#include "engine/run/recorder.h"
#include <fmt/format.h>
#include <cmath>

namespace loopwright {

Recorder::Recorder(const Plan& plan) : plan_(plan) {
  const double rows =
      double(plan.stop_tick - plan.start_tick) / double(std::max<int64_t>(plan.record_ticks, 1)) + 2;
  const double bytes = rows * double(plan.log.size() + 1) * sizeof(double);
  constexpr double most = 8e9;
  if (bytes > most) {
    Problems problems;
    auto& p = problems.error(plan.solver_place, plan.solver_place.pointer(), "",
                             fmt::format("the recording would take {:.3g} GB", bytes / 1e9));
    p.expected = fmt::format("at most {:.3g} GB", most / 1e9);
    p.hint = "a longer \"record_step\" in \"solver\", or fewer signals in \"log\"";
    throw InputError(std::move(problems));
  }
  recording_.columns.push_back({"time", "s", {}});
  for (const Plan::Logged& logged : plan.log)
    recording_.columns.push_back({logged.name, logged.unit_is_known ? to_string(logged.unit) : "", {}});
  for (Column& column : recording_.columns) column.values.reserve(size_t(rows));
}

void Recorder::record(const Run<double>& run) {
  recording_.columns[0].values.push_back(run.now().time);
  for (size_t i = 0; i < plan_.log.size(); ++i)
    recording_.columns[i + 1].values.push_back(run.number(plan_.log[i].number));
}

int Recorder::first_non_finite() const {
  for (size_t i = 0; i < plan_.log.size(); ++i)
    if (!std::isfinite(recording_.columns[i + 1].values.back())) return int(i);
  return -1;
}

}  // namespace loopwright
