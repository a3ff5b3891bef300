#include "tools/diagnose/predict/predictor.h"
#include "tools/diagnose/predict/flying_load.h"
#include "tools/diagnose/predict/linear_load.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/sizes.h"
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace loopwright::diagnosis {

uint64_t Path::next_identity() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

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
  if (path.samples() == 0) return result;  // all of it is held out
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

namespace {

/// Value and slope (per sample time) at the first of some numbers, by the straight line through them or, of
/// five and more, by the parabola (least squares). `duration`: from each to the next; empty: 1.
std::pair<double, double> begin_of(const std::vector<double>& numbers, const std::vector<double>& duration) {
  const Eigen::Index degree = numbers.size() < 5 ? 1 : 2;
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double at = 0;
  for (size_t k = 0; k < numbers.size(); ++k) {
    const Eigen::Vector3d powers(1, at, at * at);
    G += powers * powers.transpose(), b += numbers[k] * powers;
    at += duration.empty() ? 1 : duration[k];
  }
  const Eigen::VectorXd c = G.topLeftCorner(degree + 1, degree + 1).ldlt().solve(b.head(degree + 1));
  return {c[0], c[1]};
}

/// By the first readings alone: the filter soon corrects it.
double first_speed(const AxisRecord& record) {
  if (const MeasuredPort* velocity = record.find("velocity")) return velocity->value[0];
  const std::vector<double>& place = record.measured.front().value;
  return place.size() < 2 ? 0 : (place[1] - place[0]) / record.sample_time;
}

/// The speed at the first row of an axis with a load, which a wrong one moves, and which swings on for as
/// long as its damping lets it: what the model, begun without any, misses within the first time constant of
/// the filter grows with it. The difference of two readings has the noise of both and is that of the middle
/// between them.
double speed_at_start(AxisModel& model, const Drives& drives, const Pace& pace) {
  const AxisRecord& record = model.record();
  const size_t constant = size_t(double(pace.samples_to_correct) / criteria::correction),
               rows = std::min(std::max<size_t>(constant, 2), drives.input.size());
  const MeasuredPort* position = record.find("position");
  const bool is_velocity = record.find("velocity") != nullptr;
  const size_t port = is_velocity ? record.measured.size() - 1 : 0;  // the position comes first
  model.start(position ? std::optional(position->value[0]) : std::nullopt, 0);
  std::vector<double> missed;
  for (size_t k = 0; k < rows; ++k) {
    const double sensor = drives.sensor.empty() || is_velocity ? 0 : drives.sensor[k];
    missed.push_back(record.measured[port].value[k] - model.measured(port) - sensor);
    model.step(drives.input[k], -drives.force[k], record.duration.empty() ? 1 : record.duration[k]);
  }
  if (rows < 2) return is_velocity ? missed[0] : 0;
  const auto [value, slope] = begin_of(missed, record.duration);
  return is_velocity ? value : slope / record.sample_time;
}

/// By constant gains, or with a load that flies by its own.
Prediction step_along(AxisModel& model, const LinearAxis& axis, const Gains* gains, FlyingLoad* flying,
                      const Drives& drives, const Pace& pace) {
  const AxisRecord& record = model.record();
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
  model.start(position ? std::optional(position->value[0]) : std::nullopt,
              axis.load_states > 0 ? speed_at_start(model, drives, pace) : first_speed(record));
  double d = 0, passed = 0, left = 0;  // left: velocity error after the correction
  const bool follows_velocity = model.position_follows_velocity();
  int turning = 0;
  LoadDeviation loads(axis, drives.along);
  if (flying) flying->start(model.position(), model.velocity());
  const size_t a_port = flying ? flying->gains_a_port() : size_t(gains->K.rows());
  const double memory = flying ? flying->memory() : gains->memory;
  std::array<double, 2> e{};
  for (size_t k = 0; k < rows; ++k) {
    const double sensor = drives.sensor.empty() ? 0 : drives.sensor[k];
    path.predicted_position[k] = model.position();
    for (size_t p = 0; p < ports; ++p) {
      const double expected = model.measured(p) + (p == 0 && position ? sensor : 0.0);
      e[p] = record.is_false(k) ? 0 : record.measured[p].value[k] - expected;
      result.error[k * ports + p] = e[p];
    }
    const double* K = flying ? flying->gains() : gains->K.data();
    for (size_t p = 0; p < ports; ++p, K += a_port) {
      for (size_t i = 0; i < states.size(); ++i) model.correct(states[i], K[i] * e[p]);
      d += K[a_port - 1] * e[p];
      loads.correct(K, e[p]);
      if (flying) flying->correct(K, e[p]);
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
    if (flying) {
      const auto [mean, slope] =
          flying->step(path.position[k], velocity_now, (model.velocity() - velocity_now) / passed,
                       drives.input[k], path.force[k]);
      for (size_t i = 0; i < states.size(); ++i) {
        const Eigen::Index at = Eigen::Index(i);
        model.correct(states[i], -axis.push[at] * (mean + axis.slope_share[at] * slope));
      }
    }
    path.acceleration[k] = (model.velocity() - velocity_now) / passed;
    path.velocity_bow[k] =
        (model.position() - path.position[k]) / passed - 0.5 * (velocity_now + model.velocity());
    d *= memory;
  }
  return result;
}

}  // namespace

Prediction predict(AxisModel& model, const LinearAxis& axis, const Gains& gains, const Drives& drives,
                   const Pace& pace) {
  return model.record().is_map ? balance(model, gains, drives)
                               : step_along(model, axis, &gains, nullptr, drives, pace);
}

Prediction predict(AxisModel& model, const LinearAxis& axis, const Drives& drives, const Pace& pace,
                   FlyingLoad& load) {
  return step_along(model, axis, nullptr, &load, drives, pace);
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
  constexpr int with_slow = States ? States + 1 : Eigen::Dynamic;
  using Correct = Eigen::Map<const Eigen::Matrix<double, with_slow, ports>>;
  const Eigen::Matrix<double, ports, states> C = axis.C;
  const State push = axis.push;
  State difference = State::Zero(n), next(n);
  Port e(p);
  double d = 0;
  for (size_t k = 0; k < prediction.slow.size(); ++k) {
    const Eigen::Map<const Port> before(prediction.error.data() + k * size_t(p), p);
    e.noalias() = before - C * difference;
    Eigen::Map<Port>(error.data() + k * size_t(p), p) = e;
    const Correct K(to.K_at(k), n + 1, p), before_K(from.K_at(k), n + 1, p);
    difference.noalias() += K.topRows(n) * e - before_K.topRows(n) * before;
    d += K.row(n).dot(e);
    if (prediction.path.forgets(k)) d = 0;
    const Eigen::Map<const Eigen::Matrix<double, states, states>> A(axis.A_at(k).data(), n, n);
    next.noalias() = A * difference + push * (d - prediction.slow[k]);
    difference = next;
    d *= to.memory;
  }
}

/// The same for known sizes where all rows have the same gains: with matrices that are products, so that a
/// row waits for one product of the row before it, not for four. For the difference x of the states and the
/// slow force d,
///   x' = (A (I - K C) - b kᵀ C) x + b d + (A (K - K₀) + b kᵀ) e₀ - b d₀,   d' = φ (d - kᵀ C x + kᵀ e₀)
template <int States, int Ports>
void change_constant_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from,
                           const Gains& to, std::vector<double>& error) {
  using Port = Eigen::Matrix<double, Ports, 1>;
  const Eigen::Matrix<double, Ports, States> C = axis.C;
  const Eigen::Matrix<double, 1, Ports> slow_gain = to.K.row(States);
  const Eigen::Matrix<double, 1, States> of_slow = slow_gain * C;
  const Eigen::Matrix<double, States, States> A =
      axis.A * (Eigen::MatrixXd::Identity(States, States) - to.K.topRows(States) * axis.C) -
      axis.push * (to.K.row(States) * axis.C);
  const Eigen::Matrix<double, States, Ports> B =
      axis.A * (to.K.topRows(States) - from.K.topRows(States)) + axis.push * to.K.row(States);
  const Eigen::Matrix<double, States, 1> push = axis.push;
  Eigen::Matrix<double, States, 1> difference = Eigen::Matrix<double, States, 1>::Zero(), next;
  double d = 0;
  for (size_t k = 0; k < prediction.slow.size(); ++k) {
    const Port before = Eigen::Map<const Port>(prediction.error.data() + k * Ports);
    Eigen::Map<Port>(error.data() + k * Ports) = before - C * difference;
    const double corrected = d + (slow_gain.dot(before.transpose()) - of_slow.dot(difference.transpose()));
    next.noalias() = A * difference + (B * before + push * (d - prediction.slow[k]));
    if (prediction.path.forgets(k))
      next -= push * corrected, d = 0;
    else
      d = to.memory * corrected;
    difference = next;
  }
}

}  // namespace

void with_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from, const Gains& to,
                std::vector<double>& error) {
  error.resize(prediction.error.size());
  with_sizes(axis, [&]<int States, int Ports>() {
    if constexpr (States > 0)
      if (!axis.steps && !from.rows && !to.rows)
        return change_constant_gains<States, Ports>(axis, prediction, from, to, error);
    change_gains<States, Ports>(axis, prediction, from, to, error);
  });
}

void whiten(std::vector<double>& error, const Gains& gains) {
  const Eigen::Index ports = gains.whiten.rows();
  for (size_t k = 0; k < error.size(); k += size_t(ports)) {
    const double* whiten = gains.whiten_at(k / size_t(ports));
    if (ports == 1) {
      error[k] *= *whiten;
      continue;
    }
    Eigen::Map<Eigen::VectorXd> e(error.data() + k, ports);
    e = (Eigen::Map<const Eigen::MatrixXd>(whiten, ports, ports) * e).eval();
  }
}

}  // namespace loopwright::diagnosis
