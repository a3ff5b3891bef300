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
#include "engine/record/time_stamps.h"
#include "models/real/double_functions.h"
#include "models/real/fraction.h"

namespace loopwright {
namespace {

/// Reports times that are non-finite or not increasing; false if there are any.
bool check_growth(const Column& time, ProblemLimit& problems, const Place& place) {
  const std::string name = excerpt(time.name);
  double last = -std::numeric_limits<double>::infinity();
  size_t last_row = 0;
  for (size_t i = 0; i < time.values.size(); ++i) {
    const double now = time.values[i];
    if (!std::isfinite(now)) {
      problems.error(place, fmt::format("time \"{}\", row {}: {} is no time", name, i + 1, now));
      continue;  // the rows before and after it are compared with each other
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

/// The time from the first to the last row divided by the number of steps. Times are mostly written as
/// decimals: a step of 12 digits is used instead if the rounding of the last time cannot distinguish the two.
double mean_step(std::span<const double> times, double steps) {
  const double mean = (times.back() - times.front()) / steps;
  const double decimal = csv::parse_number(fmt::format("{:.12g}", mean)).value_or(mean);
  const double rounding =
      2 * std::numeric_limits<double>::epsilon() * std::max(std::abs(times.front()), std::abs(times.back()));
  return std::abs(decimal - mean) * steps <= rounding ? decimal : mean;
}

bool is_multiple(double time, double digit) {
  constexpr double rounding = 1e-6;  // of the digit
  const double count = time / digit;
  return std::abs(count - std::round(count)) <= std::max(rounding, 1e-15 * std::abs(count));
}

/// The last digit of the greatest times, where all are written with as many significant digits: early times
/// have more decimals then. With fewer digits than these, any times are alike in this way. 0: they are not,
/// or it would not be above `least`.
double last_significant_digit(std::span<const double> times, double least) {
  constexpr int least_digits = 6, most_digits = 10;
  const auto decade = [](double time) { return std::floor(decimal_logarithm(std::abs(time))); };
  const double greatest = decade(std::max(std::abs(times.front()), std::abs(times.back())));
  if (!std::isfinite(greatest)) return 0;
  for (int digits = least_digits; digits <= most_digits; ++digits) {
    if (any_power(10, greatest + 1 - digits) <= least) return 0;
    const auto is_written_so = [&](double time) {
      return time == 0 || is_multiple(time, any_power(10, decade(time) + 1 - digits));
    };
    if (std::ranges::all_of(times, is_written_so)) return any_power(10, greatest + 1 - digits);
  }
  return 0;
}

/// [sample times] The largest deviation of a time from the grid; `sample_of(row)` is the sample number of the
/// row.
template <class SampleOf>
double worst_deviation(std::span<const double> times, double sample_time, SampleOf&& sample_of) {
  double worst = 0;
  for (size_t i = 0; i < times.size(); ++i)
    worst = std::max(worst, std::abs(times[i] - (times.front() + double(sample_of(i)) * sample_time)));
  return worst / sample_time;
}

/// The error of the median of jittering steps adds up to many samples over a long record; the mean has no
/// such error. A short decimal that the last time cannot distinguish from the mean is the intended step.
double plain_step(double mean, double median, double steps) {
  constexpr double alike = 0.02, least_told = 0.5;  // of the step
  if (!(std::abs(mean - median) <= alike * median)) return median;
  const double decimal = csv::parse_number(fmt::format("{:.4g}", mean)).value_or(mean);
  return std::abs(decimal - mean) * steps <= least_told * mean ? decimal : mean;
}

/// The slope of the line through all times; the first and the last are rounded as much as the others.
template <class SampleOf> double slope_of(std::span<const double> times, SampleOf&& sample_of) {
  const double rows = double(times.size());
  double mean = 0, middle = 0, product = 0, squares = 0;
  for (size_t i = 0; i < times.size(); ++i)
    mean += (times[i] - times.front()) / rows, middle += double(sample_of(i)) / rows;
  for (size_t i = 0; i < times.size(); ++i) {
    const double k = double(sample_of(i)) - middle;
    product += k * (times[i] - times.front() - mean), squares += k * k;
  }
  return product / squares;
}

/// The shortest decimal, or else the simplest fraction of a second, that the digits of the times cannot
/// distinguish from the mean step: 1/750 for stamps that were rounded to microseconds. Where a decimal of
/// several digits and a whole number of samples a second are both possible, as 0.003334 and 1/300 for
/// milliseconds during a second, it is the one nearer to the slope.
double simplest_step(double mean, double slope, double digit, double steps) {
  constexpr int most_digits = 4, plain_digits = 2;
  if (digit == 0 || steps == 0) return mean;
  const double per_second = 1 / std::round(1 / mean);
  const bool is_rate = std::abs(per_second - mean) * steps <= digit;
  for (int digits = 1; digits <= most_digits; ++digits) {
    const double decimal = csv::parse_number(fmt::format("{:.{}g}", mean, digits)).value_or(mean);
    if (std::abs(decimal - mean) * steps > digit) continue;
    const bool is_nearer = std::abs(decimal - slope) <= std::abs(per_second - slope);
    return digits <= plain_digits || !is_rate || is_nearer ? decimal : per_second;
  }
  if (is_rate) return per_second;
  const auto fraction = to_fraction(mean, digit / (steps * mean));
  return fraction && fraction->numerator > 0 ? fraction->value() : mean;
}

/// [sample times] The spread of the times around a grid.
double spread(std::span<const double> times, std::span<const int64_t> sample, double sample_time) {
  double low = 0, high = 0;
  for (size_t i = 0; i < times.size(); ++i) {
    const double off = times[i] - times.front() - double(sample[i]) * sample_time;
    low = std::min(low, off), high = std::max(high, off);
  }
  return (high - low) / sample_time;
}

/// A grid that is even except for missing samples; without `on_grid` if it is not even. Jitter and rounding
/// can make the median step wrong, and missing samples the mean: the one with the smaller spread is right.
TimeAxis even_but_for_gaps(std::span<const double> times, double median, double tolerance) {
  TimeAxis axis{times.front(), median, false};
  const double digit = last_digit(times), all_steps = double(times.size() - 1);
  std::vector<int64_t> sample = sample_numbers(times, median);
  double even = mean_step(times, double(sample.back()));
  double mean = mean_step(times, all_steps);
  std::vector<int64_t> by_mean = sample_numbers(times, mean);
  mean = mean_step(times, double(by_mean.back()));
  by_mean = sample_numbers(times, mean);
  mean = mean_step(times, double(by_mean.back()));
  if (spread(times, by_mean, mean) < spread(times, sample, even))
    sample = std::move(by_mean), even = median = mean;
  const double steps = double(sample.back());
  axis.missing = sample.back() - int64_t(times.size() - 1);
  const double slope = slope_of(times, [&](size_t i) { return sample[i]; });
  const double simple = simplest_step(even, slope, digit, steps), apart = spread(times, sample, simple);
  const bool is_rounded = apart * simple <= 1.001 * digit;
  axis.on_grid = is_rounded || worst_deviation(times, even, [&](size_t i) { return sample[i]; }) <= tolerance;
  axis.sample_time = axis.on_grid ? simple : plain_step(even, median, steps);
  return axis;
}

}  // namespace

double last_digit(std::span<const double> times) {
  double digit = 1;
  while (digit > 0.5e-9 && !std::ranges::all_of(times, [&](double time) { return is_multiple(time, digit); }))
    digit /= 10;
  if (digit < 0.5e-9) digit = 0;
  return std::max(digit, last_significant_digit(times, digit));
}

TimeAxis check_time(const Column& time, Problems& problems, const TimeOptions& options, const Place& place) {
  ProblemLimit limit(problems, options.most_problems);
  const std::span<const double> times = time.values;
  const std::string name = excerpt(time.name);
  if (times.empty()) limit.error(place, fmt::format("time \"{}\" has no rows", name));
  if (!check_growth(time, limit, place)) return {};
  if (times.size() == 1) return {times.front(), 0, true, true};

  const double even = mean_step(times, double(times.size() - 1));
  const double deviation = worst_deviation(times, even, [](size_t i) { return i; });
  const double digit = last_digit(times), all_steps = double(times.size() - 1);
  const double slope = slope_of(times, [](size_t i) { return i; });
  const double simple = simplest_step(even, slope, digit, all_steps);
  if (deviation <= options.tolerance) return {times.front(), simple, true, true};
  const auto by_row = [](size_t i) { return i; };
  if (digit < 0.5 * simple && worst_deviation(times, simple, by_row) * simple <= 1.001 * digit)
    return {times.front(), simple, true, true};  // a fast record with rounded stamps

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
  return even_but_for_gaps(times, median, options.tolerance);
}

std::vector<int64_t> sample_numbers(std::span<const double> times, double sample_time) {
  constexpr size_t looked_ahead = 20;  // rows: a burst of late time stamps is over by then
  constexpr double followed = 0.05;    // of the deviation of a row: stamps jitter, clocks drift
  constexpr double longest_gap = 1e9;  // samples: with a billion such rows the count still fits
  std::vector<int64_t> sample(times.size());
  double expected = times.empty() ? 0 : times.front();  // expected time of the present row
  for (size_t row = 1; row < times.size(); ++row) {
    expected += sample_time;
    double skipped = longest_gap;
    for (size_t i = row; i < std::min(row + looked_ahead, times.size()) && skipped > 0.5; ++i)
      skipped = std::min(skipped, (times[i] - expected) / sample_time - double(i - row));
    skipped = skipped > 0.5 ? std::round(skipped) : 0;
    sample[row] = sample[row - 1] + 1 + int64_t(skipped);
    expected += skipped * sample_time;
    const double late = (times[row] - expected) / sample_time;
    expected += followed * std::clamp(late, -0.5, 0.5) * sample_time;
  }
  return sample;
}

std::vector<double> unrounded(std::span<const double> times, const TimeAxis& axis) {
  constexpr size_t least_rows = 50;  // so many steps of whole digits follow no line by chance
  constexpr double least_digit = 1e-3, on_grid = 1e-6;  // of the sample time
  const double digit = last_digit(times);
  if (!axis.on_grid || times.size() < least_rows || digit < least_digit * axis.sample_time) return {};
  const std::vector<int64_t> sample = sample_numbers(times, axis.sample_time);
  const double apart = spread(times, sample, axis.sample_time);
  if (apart <= on_grid || apart * axis.sample_time > 1.001 * digit) return {};
  std::vector<double> instants;
  for (const int64_t count : sample) instants.push_back(times.front() + double(count) * axis.sample_time);
  return instants;
}

}  // namespace loopwright
