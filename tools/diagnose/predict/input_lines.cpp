#include "tools/diagnose/predict/input_lines.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

/// The line over a sample of this length with this integral, and this one of (t - middle) times the signal.
InputLine line_of(double integral, double moment, double length) {
  const double slope = 12 * moment / (length * length * length);
  return {integral / length - slope * length / 2, slope};
}

/// What is added to integral and moment by v + s (t - begin) from `from` to `to`.
void add_piece(double v, double s, double begin, double from, double to, double middle, double& integral,
               double& moment) {
  const double length = to - from, centre = 0.5 * (from + to), value = v + s * (centre - begin);
  integral += value * length;
  moment += value * length * (centre - middle) + s * length * length * length / 12;
}

/// (1 - e^-q)/q, and its first moment: ((1 - e^-q) - (1 + e^-q) q/2)/q².
struct Decay {
  double mean, moment;
  explicit Decay(double q) {
    constexpr double small = 1e-2;  // below, the difference would cancel
    mean = -std::expm1(-q) / q;
    moment = q < small ? -q / 12 * (1 - q / 2) : (mean - 0.5 * (1 + std::exp(-q))) / q;
  }
};

}  // namespace

InputLines lines_of(const SignalRecord& record, const RecordedInput& input) {
  InputLines lines;
  lines.reserve(record.rows());
  while (lines.size() < record.rows()) {  // one record after the other
    const size_t first = lines.size();
    size_t end = first + 1;
    while (end < record.rows() && !record.begins_at(end)) ++end;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + std::ptrdiff_t(first), all.begin() + std::ptrdiff_t(end));
    };
    const RowCurve curve(part(record.time), part(input.value), input.between_rows);
    for (size_t row = first; row < end; ++row) {
      const CubicPiece piece = curve.piece(row - first);
      const auto [mean, change] = piece.line();
      lines.push_back({mean - change / 2, change / piece.length});
    }
  }
  return lines;
}

InputLines delayed(const SignalRecord& record, const InputLines& input, double delay, double before) {
  InputLines lines(input.size());
  size_t first = 0, piece = 0;  // first row of the record, and that of the line that acts
  for (size_t row = 0; row < lines.size(); ++row) {
    if (record.begins_at(row)) first = piece = row;
    const double length = record.step(row), from = record.time[row] - delay, to = from + length;
    while (piece < row && record.time[piece + 1] <= from) ++piece;
    const double begin = std::min(to, record.time[first]);
    double integral = 0, moment = 0, at = from;
    const double middle = 0.5 * (from + to);
    if (begin > from) {
      add_piece(before, 0, from, from, begin, middle, integral, moment);
      at = begin;
    }
    for (size_t p = piece; at < to; ++p) {
      const double end = p < row ? std::min(to, record.time[p + 1]) : to;
      add_piece(input[p].value, input[p].slope, record.time[p], at, end, middle, integral, moment);
      at = end;
    }
    lines[row] = line_of(integral, moment, length);
  }
  return lines;
}

InputLines lagged(const SignalRecord& record, const InputLines& input, double time_constant, double before) {
  InputLines lines(input.size());
  double z = 0;
  for (size_t row = 0; row < lines.size(); ++row) {
    const auto [v, s] = input[row];
    if (record.begins_at(row)) z = before;
    const double length = record.step(row), q = length / time_constant;
    const double away = z - v + s * time_constant;  // decays within the sample
    const Decay decay(q);
    const double mean = v + s * (0.5 * length - time_constant) + away * decay.mean;
    const double slope = s + 12 * away * decay.moment / length;
    lines[row] = {mean - slope * length / 2, slope};
    z = v + s * (length - time_constant) + away * std::exp(-q);
  }
  return lines;
}

InputLines difference(InputLines first, const InputLines& second) {
  for (size_t row = 0; row < first.size(); ++row)
    first[row].value -= second[row].value, first[row].slope -= second[row].slope;
  return first;
}

}  // namespace loopwright::diagnosis
