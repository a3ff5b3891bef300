#include "tools/diagnose/predict/predictor.h"
#include "tools/diagnose/predict/in_parallel.h"
#include "tools/diagnose/predict/linear_load.h"
#include "tools/diagnose/predict/sizes.h"
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

namespace loopwright::diagnosis {

uint64_t Path::next_identity() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

namespace {

/// Columns filtered in parallel, so that no column waits for its own previous sample. Vector types of the
/// compiler become wider instructions in a function compiled for them. The bits stay the same, because
/// nothing is contracted.
constexpr int side_by_side = 8;
struct Side {
  using Half = double __attribute__((vector_size(side_by_side * sizeof(double) / 2)));
  Half low{}, high{};
};
[[gnu::always_inline]] inline Side operator*(double a, const Side& b) { return {a * b.low, a * b.high}; }
[[gnu::always_inline]] inline Side operator+(const Side& a, const Side& b) {
  return {a.low + b.low, a.high + b.high};
}
[[gnu::always_inline]] inline Side operator-(const Side& a, const Side& b) {
  return {a.low - b.low, a.high - b.high};
}

/// The error filter with states (x, d): the response of the prediction errors to small forces and sensor
/// errors. Sizes known at compile time make it three times as fast; `States` and `Ports` are 0 for any size.
template <int States, int Ports> class ErrorFilter {
 public:
  ErrorFilter(const LinearAxis& axis, const Gains& gains, bool is_input)
      : n_(int(axis.A.rows())), ports_(int(axis.C.rows())), memory_(gains.memory) {
    for (int i = 0; i < n(); ++i) {
      for (int j = 0; j < n(); ++j) A_[i][j] = axis.A(i, j);
      push_[i] = axis.push[i];
      enters_[i] = is_input ? axis.input_push[i] : push_[i];
      bends_[i] = axis.slope_share[i] * enters_[i];
      x_[i] = Side{};
    }
    for (int p = 0; p < ports(); ++p) {
      for (int i = 0; i <= n(); ++i) K_[i][p] = gains.K(i, p);
      for (int j = 0; j < n(); ++j) C_[p][j] = axis.C(p, j);
      for (int q = 0; q < ports(); ++q) whiten_[p][q] = gains.whiten(p, q);
    }
    d_ = Side{};
  }

  /// Deviations from the prediction, in the measured ports.
  [[gnu::always_inline]] void seen(Side* e) const {
    for (int p = 0; p < ports(); ++p) {
      e[p] = Side{};
      for (int j = 0; j < n(); ++j) e[p] = e[p] + C_[p][j] * x_[j];
    }
  }
  /// The predictor corrects itself by the measurement; the true state advances with the consumed forces.
  [[gnu::always_inline]] void step(const Side* e, const Side& force, const Side& slope, bool forgets) {
    for (int p = 0; p < ports(); ++p) {
      for (int i = 0; i < n(); ++i) x_[i] = x_[i] - K_[i][p] * e[p];
      d_ = d_ - K_[n()][p] * e[p];
    }
    if (forgets) d_ = Side{};
    Side next[most_];
    for (int i = 0; i < n(); ++i) {
      next[i] = push_[i] * d_ - enters_[i] * force - bends_[i] * slope;
      for (int j = 0; j < n(); ++j) next[i] = next[i] + A_[i][j] * x_[j];
    }
    for (int i = 0; i < n(); ++i) x_[i] = next[i];
    d_ = memory_ * d_;
  }
  [[gnu::always_inline]] Side white(const Side* e, int port) const {
    Side sum{};
    for (int q = 0; q <= port; ++q) sum = sum + whiten_[port][q] * e[q];
    return sum;
  }
  [[gnu::always_inline]] int n() const { return States > 0 ? States : n_; }
  [[gnu::always_inline]] int ports() const { return Ports > 0 ? Ports : ports_; }

 private:
  static constexpr int most_ = States > 0 ? States + 1 : 24;
  const int n_, ports_;
  const double memory_;
  double A_[most_][most_], push_[most_], enters_[most_], bends_[most_], C_[2][most_], K_[most_][2],
      whiten_[2][2];
  Side x_[most_], d_;
};

/// Some rows of the columns, row by row: scalar stores followed by a vector load would stall the processor.
constexpr size_t rows_at_a_time = 64;
using Block = std::array<Side, rows_at_a_time>;

[[gnu::always_inline]] inline void gather(const Column::Numbers& from, size_t row, size_t count, size_t place,
                                          Block& to) {
  const float* numbers = from->data() + row;
  double* lane = reinterpret_cast<double*>(to.data()) + place;
  for (size_t r = 0; r < count; ++r) lane[r * side_by_side] = double(numbers[r]);
}

/// Destination of the responses of the columns: the ports of each requested row, one after the other.
struct Rows {
  std::span<const size_t> wanted;  ///< ascending
  std::span<double* const> to;     ///< of each column
};

/// At most `side_by_side` columns.
template <class Filter>
[[gnu::always_inline]] inline void run(Filter filter, const Path& path, Acts acts,
                                       std::span<const Column* const> columns, const Rows& rows) {
  const size_t ports = size_t(filter.ports());
  Block drive{}, slope{}, white[2];
  size_t next = 0;
  for (size_t first = 0; next < rows.wanted.size(); first += rows_at_a_time) {
    const size_t count = std::min(rows_at_a_time, path.samples() - first);
    for (size_t c = 0; c < columns.size(); ++c) {
      gather(columns[c]->mean, first, count, c, drive);
      if (columns[c]->slope) gather(columns[c]->slope, first, count, c, slope);
    }
    for (size_t r = 0; r < count; ++r) {
      Side e[2];
      filter.seen(e);
      if (acts == Acts::sensor) e[0] = e[0] + drive[r];
      for (size_t p = 0; p < ports; ++p) white[p][r] = filter.white(e, int(p));
      filter.step(e, acts == Acts::sensor ? Side{} : drive[r], slope[r], path.forgets(first + r));
    }
    const size_t begin = next;
    while (next < rows.wanted.size() && rows.wanted[next] < first + count) ++next;
    for (size_t c = 0; c < columns.size(); ++c)
      for (size_t p = 0; p < ports; ++p) {
        const double* lane = reinterpret_cast<const double*>(white[p].data()) + c;
        for (size_t i = begin; i < next; ++i)
          rows.to[c][i * ports + p] = lane[(rows.wanted[i] - first) * side_by_side];
      }
  }
}
template <class Filter>
[[gnu::target("avx2")]] void run_wide(const Filter& filter, const Path& path, Acts acts,
                                      std::span<const Column* const> columns, const Rows& rows) {
  run(filter, path, acts, columns, rows);
}
template <class Filter>
void run_on_this_machine(const Filter& filter, const Path& path, Acts acts,
                         std::span<const Column* const> columns, const Rows& rows) {
  if (__builtin_cpu_supports("avx2"))
    run_wide(filter, path, acts, columns, rows);
  else
    run(filter, path, acts, columns, rows);
}

}  // namespace

Path Path::first_samples(size_t count) const {
  Path shorter = *this;
  shorter.identity = next_identity();
  for (auto* list : {&shorter.position, &shorter.velocity, &shorter.acceleration, &shorter.velocity_bow,
                     &shorter.input, &shorter.force, &shorter.predicted_position})
    list->resize(count);
  if (!input_slope.empty()) shorter.input_slope.resize(count);
  if (!duration.empty()) shorter.duration.resize(count);
  shorter.rests.resize(count), shorter.turns.resize(count);
  return shorter;
}

Path creep_along(const AxisRecord& map, size_t rows) {
  constexpr double creep = 1e-9;  // fraction of the way to the next balance
  const std::vector<double>& position = map.find("position")->value;
  Path path;
  path.identity = Path::next_identity(), path.sample_time = map.sample_time;
  path.position = {position.begin(), position.begin() + std::ptrdiff_t(rows)};
  path.predicted_position = path.position, path.input = map.input;
  for (auto* list : {&path.velocity, &path.acceleration, &path.velocity_bow}) list->resize(rows);
  path.rests.resize(rows), path.turns.resize(rows);
  for (size_t k = 0; k < rows; ++k)
    if (k + 1 < position.size())
      path.velocity[k] = creep * (position[k + 1] - position[k]) / path.sample_time;
  return path;
}

std::vector<const Column*> pointers(const Columns& columns) {
  std::vector<const Column*> list;
  for (const Column& column : columns) list.push_back(&column);
  return list;
}

void responses(const LinearAxis& axis, const Gains& gains, const Path& path, Acts acts,
               std::span<const Column* const> columns, std::span<const size_t> rows,
               std::span<double* const> to) {
  const bool is_input = acts == Acts::input;
  in_parallel((columns.size() + side_by_side - 1) / side_by_side, [&](size_t part) {
    const size_t first = part * side_by_side, count = std::min<size_t>(side_by_side, columns.size() - first);
    const auto some = columns.subspan(first, count);
    const Rows wanted{rows, to.subspan(first, count)};
    with_sizes(axis, [&]<int States, int Ports>() {
      run_on_this_machine(ErrorFilter<States, Ports>(axis, gains, is_input), path, acts, some, wanted);
    });
  });
}

std::vector<std::vector<double>> responses(const LinearAxis& axis, const Gains& gains, const Path& path,
                                           Acts acts, std::span<const Column* const> columns) {
  std::vector<size_t> rows(path.samples());
  std::iota(rows.begin(), rows.end(), size_t(0));
  std::vector<std::vector<double>> out(columns.size(),
                                       std::vector<double>(rows.size() * size_t(axis.C.rows())));
  std::vector<double*> to;
  for (std::vector<double>& column : out) to.push_back(column.data());
  responses(axis, gains, path, acts, columns, rows, to);
  return out;
}

namespace {

std::vector<double> first_rows(const std::vector<double>& all, size_t rows) {
  return {all.begin(), all.begin() + std::ptrdiff_t(rows)};
}

/// At the balances of a map, the remaining sum of the model's forces is the error.
Prediction balance(AxisModel& model, const Gains& gains, const Drives& drives) {
  Prediction result;
  Path& path = result.path = creep_along(model.record(), drives.input.size());
  path.input = drives.input, path.force = first_rows(model.driving_force(), path.samples());
  result.error.resize(path.samples()), result.slow.resize(path.samples());
  model.start(path.position[0], 0);
  double d = 0, expected = 0;
  for (size_t k = 0; k < path.samples(); ++k) {
    result.error[k] = -expected;
    d -= gains.K(1, 0) * expected;
    result.slow[k] = d;
    expected =
        model.net_force_at_rest(path.position[k], path.velocity[k], drives.input[k], d - drives.force[k]);
    d *= gains.memory;
  }
  return result;
}

}  // namespace

double correction_time(const LinearAxis& axis, const Gains& gains) {
  const Eigen::Index n = axis.A.rows(), own = n - axis.load_states;
  const Eigen::MatrixXd closed = axis.A * (Eigen::MatrixXd::Identity(n, n) - gains.K.topRows(n) * axis.C);
  const double slowest = closed.topLeftCorner(own, own).eigenvalues().cwiseAbs().maxCoeff();
  return slowest > 0 ? -1 / std::log(std::min(slowest, 1 - 1e-9)) : 0;
}

Prediction predict(AxisModel& model, const LinearAxis& axis, const Gains& gains, const Drives& drives,
                   const Pace& pace) {
  const AxisRecord& record = model.record();
  if (record.is_map) return balance(model, gains, drives);
  const size_t rows = drives.input.size(), ports = record.measured.size();
  const std::span<const int> states = model.states();
  Prediction result;
  result.error.resize(rows * ports), result.slow.resize(rows);
  Path& path = result.path;
  path.identity = Path::next_identity(), path.sample_time = record.sample_time;
  for (auto* list : {&path.position, &path.velocity, &path.acceleration, &path.velocity_bow})
    list->resize(rows);
  path.input = drives.input, path.force = first_rows(model.driving_force(), rows);
  path.predicted_position.resize(rows), path.rests.resize(rows), path.turns.resize(rows);
  if (!record.input_slope.empty()) path.input_slope = first_rows(record.input_slope, rows);
  if (!record.duration.empty()) path.duration = first_rows(record.duration, rows);
  const MeasuredPort* position = record.find("position");
  const MeasuredPort* velocity = record.find("velocity");
  const auto& first = record.measured.front().value;
  model.start(
      position ? std::optional(position->value[0]) : std::nullopt,
      velocity ? velocity->value[0] : (first[std::min<size_t>(rows - 1, 1)] - first[0]) / record.sample_time);
  double d = 0, passed = 0, left = 0;  // left: velocity error after the correction
  const bool follows_velocity = model.position_follows_velocity();
  int turning = 0;
  LoadDeviation loads(axis, gains, drives.along);
  std::array<double, 2> e{};
  for (size_t k = 0; k < rows; ++k) {
    const double sensor = drives.sensor.empty() ? 0 : drives.sensor[k];
    path.predicted_position[k] = model.position();
    for (size_t p = 0; p < ports; ++p) {
      const double expected = model.measured(p) + (p == 0 && position ? sensor : 0.0);
      e[p] = record.is_false(k) ? 0 : record.measured[p].value[k] - expected;
      result.error[k * ports + p] = e[p];
    }
    for (size_t p = 0; p < ports; ++p) {
      for (size_t i = 0; i < states.size(); ++i)
        model.correct(states[i], gains.K(Eigen::Index(i), Eigen::Index(p)) * e[p]);
      d += gains.K(gains.K.rows() - 1, Eigen::Index(p)) * e[p];
      loads.correct(p, e[p]);
    }
    if (follows_velocity) {
      if (!record.is_missing(k)) model.shift_position(0.5 * passed * (left + e[0]));
      left = record.is_missing(k) || record.is_false(k) ? 0 : velocity->value[k] - model.velocity();
    }
    const double velocity_now = model.velocity();
    path.position[k] = model.position(), path.velocity[k] = velocity_now;
    path.rests[k] = std::abs(velocity_now) < pace.rest_speed;
    const bool turned = k > 0 && (velocity_now > 0) != (path.velocity[k - 1] > 0);
    turning = turned || record.is_missing(k) ? pace.samples_to_correct : std::max(0, turning - 1);
    path.turns[k] = turning > 0;
    if (path.forgets(k)) d = 0;
    result.slow[k] = d;
    const double duration = record.duration.empty() ? 1 : record.duration[k];
    const double by_loads = loads.force(k, path.position[k], velocity_now);
    model.step(drives.input[k], d - drives.force[k] - by_loads, duration);
    for (size_t i = 0; i < states.size(); ++i) {
      const Eigen::Index at = Eigen::Index(i);
      double by = 0;
      if (!drives.input_slope.empty()) by += axis.input_push[at] * drives.input_slope[k];
      if (!drives.force_slope.empty()) by -= axis.push[at] * drives.force_slope[k];
      if (axis.slope_share[at] != 0) model.correct(states[i], axis.slope_share[at] * by);
    }
    passed = duration * record.sample_time;
    path.acceleration[k] = (model.velocity() - velocity_now) / passed;
    path.velocity_bow[k] =
        (model.position() - path.position[k]) / passed - 0.5 * (velocity_now + model.velocity());
    d *= gains.memory;
  }
  return result;
}

namespace {

/// with_gains for sizes known at compile time; 0: any.
template <int States, int Ports>
void change_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from, const Gains& to,
                  std::vector<double>& error) {
  constexpr int states = States ? States : Eigen::Dynamic, ports = Ports ? Ports : Eigen::Dynamic;
  using State = Eigen::Matrix<double, states, 1>;
  using Port = Eigen::Matrix<double, ports, 1>;
  const Eigen::Index n = axis.A.rows(), p = axis.C.rows();
  const Eigen::Matrix<double, states, states> A = axis.A;
  const Eigen::Matrix<double, ports, states> C = axis.C;
  const Eigen::Matrix<double, states, ports> K = to.K.topRows(n), before_K = from.K.topRows(n);
  const Port slow_K = to.K.row(n).transpose();
  const State push = axis.push;
  State difference = State::Zero(n), next(n);
  Port e(p);
  double d = 0;
  for (size_t k = 0; k < prediction.slow.size(); ++k) {
    const Eigen::Map<const Port> before(prediction.error.data() + k * size_t(p), p);
    e.noalias() = before - C * difference;
    Eigen::Map<Port>(error.data() + k * size_t(p), p) = e;
    difference.noalias() += K * e - before_K * before;
    d += slow_K.dot(e);
    if (prediction.path.forgets(k)) d = 0;
    next.noalias() = A * difference + push * (d - prediction.slow[k]);
    difference = next;
    d *= to.memory;
  }
}

}  // namespace

void with_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from, const Gains& to,
                std::vector<double>& error) {
  error.resize(prediction.error.size());
  with_sizes(
      axis, [&]<int States, int Ports>() { change_gains<States, Ports>(axis, prediction, from, to, error); });
}

void whiten(std::vector<double>& error, const Gains& gains) {
  const Eigen::Index ports = gains.whiten.rows();
  for (size_t k = 0; k < error.size(); k += size_t(ports)) {
    if (ports == 1) {
      error[k] *= gains.whiten(0, 0);
      continue;
    }
    Eigen::Map<Eigen::VectorXd> e(error.data() + k, ports);
    e = (gains.whiten * e).eval();
  }
}

}  // namespace loopwright::diagnosis
