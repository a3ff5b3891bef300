#include "engine/record/time_axis.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/record/csv_syntax.h"
#include "engine/json/problem_limit.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

/// Errors for times that are no numbers or do not grow; false if there are any.
bool check_growth(const Column& time, ProblemLimit& problems, const Place& place) {
  const std::string name = excerpt(time.name);
  double last = -std::numeric_limits<double>::infinity();
  size_t last_row = 0;
  for (size_t i = 0; i < time.values.size(); ++i) {
    const double now = time.values[i];
    if (!std::isfinite(now)) {
      problems.error(place, fmt::format("time \"{}\", row {}: {} is no time", name, i + 1, now));
      continue;  // the rows around it are compared with each other
    }
    if (now == last) {
      problems.error(place, fmt::format("time \"{}\", row {}: the time {} s of row {} again", name, i + 1,
                                        now, last_row));
    } else if (now < last) {
      problems.error(
          place,
          fmt::format("time \"{}\", row {}: the time goes back from {} s to {} s", name, i + 1, last, now),
          "growing times", {}, "two recordings in one file, or a counter that wrapped around?");
    }
    last = now;
    last_row = i + 1;
  }
  return !problems.has_errors();
}

double median_step(std::span<const double> times) {
  std::vector<double> steps;
  for (size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// The step from first to last time, evenly divided. Times are mostly written as decimals: a step of 12
/// digits is taken instead where rounding of the last time cannot tell the two apart.
double mean_step(std::span<const double> times) {
  const double steps = static_cast<double>(times.size() - 1);
  const double mean = (times.back() - times.front()) / steps;
  const double decimal = csv::parse_number(fmt::format("{:.12g}", mean)).value_or(mean);
  const double rounding =
      2 * std::numeric_limits<double>::epsilon() * std::max(std::abs(times.front()), std::abs(times.back()));
  return std::abs(decimal - mean) * steps <= rounding ? decimal : mean;
}

/// [sample times] How far the worst time lies from the grid.
double worst_deviation(std::span<const double> times, double sample_time) {
  double worst = 0;
  for (size_t i = 0; i < times.size(); ++i)
    worst = std::max(worst, std::abs(times[i] - (times.front() + static_cast<double>(i) * sample_time)));
  return worst / sample_time;
}

}  // namespace

TimeAxis check_time(const Column& time, Problems& problems, const TimeOptions& options, const Place& place) {
  ProblemLimit limit(problems, options.most_problems);
  const std::span<const double> times = time.values;
  const std::string name = excerpt(time.name);
  if (times.empty()) limit.error(place, fmt::format("time \"{}\" has no rows", name));
  if (!check_growth(time, limit, place)) return {};
  if (times.size() == 1) return {times.front(), 0, true};

  const double even = mean_step(times);
  const double deviation = worst_deviation(times, even);
  if (deviation <= options.tolerance) return {times.front(), even, true};

  const auto tell = [&](std::string message, std::string hint) {
    if (options.must_be_regular)
      limit.error(place, std::move(message), {}, {}, std::move(hint));
    else
      limit.warning(place, std::move(message), std::move(hint));
  };
  const double median = median_step(times);
  tell(fmt::format("time \"{}\" is not sampled evenly: a time lies {:.3g} sample times off the grid", name,
                   deviation),
       fmt::format("the median step is {:.6g} s; up to {} sample times are tolerated", median,
                   options.tolerance));
  for (size_t i = 1; i < times.size(); ++i) {
    const double step = times[i] - times[i - 1];
    if (step > options.gap * median)
      tell(fmt::format("time \"{}\", row {}: a gap of {:.6g} s behind {} s", name, i + 1, step, times[i - 1]),
           fmt::format("about {:.0f} samples are missing", std::round(step / median) - 1));
  }
  return {times.front(), median, false};
}

}  // namespace loopwright
