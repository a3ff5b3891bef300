#include "tools/diagnose/verdict/remainder_interval.h"
#include <algorithm>
#include <numeric>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// Of each row; zero at rows that are not there.
std::vector<double> squared_errors(const Trial& trial, const Fitted& fitted, size_t ports) {
  std::vector<double> squares(fitted.white.size() / ports);
  for (size_t k = 0; k < squares.size(); ++k)
    for (size_t p = 0; p < ports && !trial.model->record().is_missing(k); ++p)
      squares[k] += fitted.white[k * ports + p] * fitted.white[k * ports + p];
  return squares;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// First and last row of the shortest stretch that sums up to so much.
std::pair<size_t, size_t> shortest_stretch(const std::vector<double>& values, double wanted) {
  std::pair<size_t, size_t> best{0, values.size() - 1};
  double sum = 0;
  for (size_t from = 0, to = 0; to < values.size(); ++to) {
    sum += values[to];
    for (; sum - values[from] >= wanted && from < to; ++from) sum -= values[from];
    if (sum >= wanted && to - from < best.second - best.first) best = {from, to};
  }
  return best;
}

}  // namespace

std::optional<RemainderInterval> interval_of_remainder(const Trials& trials,
                                                       const std::vector<Fitted>& fitted) {
  std::vector<double> squares;
  size_t record = 0;
  for (size_t t = 0; t < trials.list.size() && !trials.has_map(); ++t) {
    std::vector<double> own = squared_errors(trials.list[t], fitted[t], trials.ports());
    if (squares.empty() || sum_of(own) > sum_of(squares)) squares = std::move(own), record = t;
  }
  if (squares.empty()) return {};
  const auto [from, to] = shortest_stretch(squares, criteria::most_of_remainder * sum_of(squares));
  const AxisRecord& read = trials.list[record].model->record();
  const std::vector<double> place = places_of_rows(read);
  const auto time = [&](size_t row) {
    return read.start + place[std::min(row, place.size() - 1)] * read.sample_time;
  };
  if (time(to) - time(from) > criteria::short_part_of_record * (time(squares.size()) - read.start)) return {};
  return RemainderInterval{record + 1, time(from), time(to)};
}

}  // namespace loopwright::diagnosis
