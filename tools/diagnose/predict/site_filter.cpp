#include "tools/diagnose/predict/site_filter.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace loopwright::diagnosis {
namespace {

using Map = Eigen::Map<Eigen::VectorXd>;
using ConstMap = Eigen::Map<const Eigen::VectorXd>;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
/// [of the size of a state] What is known about it before the first row.
constexpr double initial_deviation = 10;
/// Where the model is not finite after a correction, it is halved, and left out when so little is left of it.
constexpr double least_share_of_correction = 0.01;

}  // namespace

double SitePass::scaled_objective() const {
  const double count = double(readings);
  return log_variances + count * std::log(squares / count) + count;
}

SiteFilter::SiteFilter(SiteModel& model)
    : model_(model), record_(model.record()), model_states_(size_t(model.states())) {
  y_.resize(record_.outputs.size()), y_moved_.resize(record_.outputs.size());
  guess_scales(1);
}

void SiteFilter::guess_scales(double site) {
  site_scale_.assign(model_.sites().size(), site);
  state_scale_.assign(model_states_, 1.0);
  const std::vector<double> initial = initial_states(0);
  for (size_t i = 0; i < initial.size(); ++i)
    if (initial[i] != 0) state_scale_[i] = std::abs(initial[i]);
  for (size_t j = 0; j < record_.outputs.size(); ++j) {
    double largest = 0;
    for (double y : record_.outputs[j].value)
      if (std::isfinite(y)) largest = std::max(largest, std::abs(y));
    if (const int state = model_.measured_state(j); state >= 0 && largest > 0)
      state_scale_[size_t(state)] = largest;
  }
}

SiteNoise SiteFilter::guess_noise() const {
  SiteNoise noise;
  for (size_t s = 0; s < model_.sites().size(); ++s)
    if (model_.drives_state(int(s))) noise.sites.push_back(int(s));
  for (int site : noise.sites) noise.process.push_back(site_scale_[size_t(site)]);
  for (const RecordedOutput& output : record_.outputs) {
    // The third difference of white noise has twenty times its variance; that of a smooth signal vanishes.
    // A sensor may be read in some rows only.
    double squares = 0, count = 0, largest = 0;
    std::array<double, 4> reading{};
    size_t readings = 0;  // one after the other, of one record
    for (size_t k = 0; k < output.value.size(); ++k) {
      if (record_.begins_at(k)) readings = 0;
      if (!std::isfinite(output.value[k])) continue;
      std::ranges::rotate(reading, reading.begin() + 1);
      reading[3] = output.value[k], largest = std::max(largest, std::abs(reading[3]));
      if (++readings < 4) continue;
      squares += squared(reading[3] - 3 * reading[2] + 3 * reading[1] - reading[0]) / 20, count += 1;
    }
    const double counts = output.resolution / std::sqrt(12);
    noise.measurement.push_back(
        std::max({count > 0 ? std::sqrt(squares / count) : 0.0, counts, 1e-9 * largest}));
  }
  return noise;
}

SiteNoise SiteFilter::noise_of_simulation() const {
  constexpr double little = 1e-3;    // [of a size of notable effect]
  constexpr double first_size = 10;  // [of the measurement noise]
  constexpr double first_time = 20;  // [samples]
  SiteNoise noise = guess_noise();
  noise.is_of_simulation = true;
  for (double& sigma : noise.process) sigma *= little;
  for (size_t j = 0; j < noise.measurement.size(); ++j)
    noise.slow.push_back({int(j), -1, first_size * noise.measurement[j], first_time * record_.sample_time});
  return noise;
}

SiteNoise SiteFilter::with_disturbance(SiteNoise noise, int site) const {
  constexpr double first_size = 3;   // [of the white noise]
  constexpr double first_time = 50;  // [samples]
  const size_t at = size_t(std::ranges::find(noise.sites, site) - noise.sites.begin());
  noise.slow.push_back({-1, site, first_size * noise.process[at], first_time * record_.sample_time});
  return noise;
}

void SiteFilter::learn_scales(const SitePass& pass) {
  const size_t n = pass.states;
  for (size_t i = 0; i < model_states_; ++i) {
    std::vector<double> sizes;
    for (size_t k = pass.rows / 10; k < pass.rows; ++k) sizes.push_back(std::abs(pass.filtered[k * n + i]));
    const auto high = sizes.begin() + std::ptrdiff_t(9 * sizes.size() / 10);
    std::ranges::nth_element(sizes, high);
    if (*high > 0 && std::isfinite(*high)) state_scale_[i] = *high;
  }
  for (size_t s = 0; s < pass.sites; ++s)
    if (const double size = notable_size(&pass.G[s * n]); std::isfinite(size)) site_scale_[s] = size;
}

void SiteFilter::allocate(size_t rows, bool with_columns, SitePass& pass) {
  const size_t n = model_states_ + pass.noise.slow.size(), outputs = record_.outputs.size(),
               sites = model_.sites().size();
  pass.rows = rows, pass.states = n, pass.outputs = outputs, pass.sites = sites;
  pass.numbers = size_t(model_.numbers()), pass.has_columns = with_columns;
  for (auto* list : {&pass.error, &pass.variance, &pass.innovation}) list->resize(rows * outputs);
  for (auto* list : {&pass.C, &pass.gain}) list->resize(rows * outputs * n);
  for (auto* list : {&pass.correction, &pass.filtered}) list->resize(rows * n);
  pass.share.resize(rows);
  pass.modes.resize(rows * model_.mode_bytes() + 1), modes_.resize(model_.mode_bytes() + 1);
  pass.A.resize(rows * n * n), pass.G.resize(rows * sites * n);
  P_.resize(Eigen::Index(n), Eigen::Index(n)), product_.resize(Eigen::Index(n), Eigen::Index(n));
  for (Eigen::VectorXd* v : {&x_, &next_, &moved_, &moved_next_, &middle_, &gain_, &delta_, &difference_})
    v->setZero(Eigen::Index(n));
  if (!with_columns) return;
  pass.ramp.resize(rows * sites * n);
  for (auto& path : pass.path) path.resize(rows * pass.numbers);
}

std::vector<double> SiteFilter::initial_states(size_t row) {
  std::vector<double> states = model_.initial_states(row);
  start_modes_.resize(model_.mode_bytes());
  model_.keep_modes(row, start_modes_.data());
  for (size_t j = 0; j < record_.outputs.size(); ++j)
    if (const int state = model_.measured_state(j); state >= 0)
      for (size_t k = row; k < record_.rows() && (k == row || !record_.begins_at(k)); ++k)
        if (const double y = record_.outputs[j].value[k]; std::isfinite(y)) {
          states[size_t(state)] = y;
          break;
        }
  return states;
}

void SiteFilter::begin_at(size_t row) {
  const std::vector<double> initial = initial_states(row);
  x_.setZero();
  x_.head(Eigen::Index(model_states_)) = ConstMap(initial.data(), Eigen::Index(model_states_));
  if (model_.flow(row, initial.data(), next_.data())) {
    model_.put_modes_back(row, start_modes_.data());
    return;
  }
  // The noise of a reading may be where no state can be, as a level below an empty tank.
  const std::vector<double> stated = model_.initial_states(row);
  x_.head(Eigen::Index(model_states_)) = ConstMap(stated.data(), Eigen::Index(model_states_));
}

double SiteFilter::initial_variance(const SiteNoise& noise, size_t state) const {
  if (state >= model_states_) return squared(noise.slow[state - model_states_].size);
  return squared(initial_deviation * state_scale_[state]);
}

void SiteFilter::begin_covariance(const SiteNoise& noise) {
  P_.setZero();
  for (Eigen::Index i = 0; i < P_.rows(); ++i) P_(i, i) = initial_variance(noise, size_t(i));
}

void SiteFilter::add_slow_errors(const SiteNoise& noise) {
  for (size_t j = 0; j < noise.slow.size(); ++j)
    if (const int output = noise.slow[j].output; output >= 0)
      y_[size_t(output)] += x_[Eigen::Index(model_states_ + j)];
}

void SiteFilter::hold_disturbances(const SiteNoise& noise) {
  for (size_t j = 0; j < noise.slow.size(); ++j)
    if (const int site = noise.slow[j].site; site >= 0)
      model_.hold(site, x_[Eigen::Index(model_states_ + j)]);
}

void SiteFilter::release_disturbances(const SiteNoise& noise) {
  for (const SlowNoise& slow : noise.slow)
    if (slow.site >= 0) model_.hold(slow.site, 0);
}

bool SiteFilter::advance(size_t row, const SiteNoise& noise, double* middle, FlowSlopes* slopes) {
  hold_disturbances(noise);
  const bool good = model_.flow(row, x_.data(), next_.data(), middle, slopes);
  release_disturbances(noise);
  for (size_t j = 0; j < noise.slow.size(); ++j) {
    const auto i = Eigen::Index(model_states_ + j);
    next_[i] = noise.slow[j].kept(record_.step(row)) * x_[i];
  }
  return good;
}

bool SiteFilter::advance_from_correction(size_t row, const SitePass& pass, double* middle, double& share,
                                         FlowSlopes* slopes) {
  const Eigen::VectorXd corrected = x_;
  for (share = 1; share > least_share_of_correction; share /= 2) {
    x_ = corrected - (1 - share) * delta_;
    if (advance(row, pass.noise, middle, slopes)) return true;
    model_.put_modes_back(row, &pass.modes[row * model_.mode_bytes()]);
  }
  x_ = corrected - delta_, share = 0;
  return advance(row, pass.noise, middle, slopes);
}

void SiteFilter::keep_correction(size_t row, double share, SitePass& pass) const {
  const auto n = Eigen::Index(pass.states);
  pass.share[row] = share;
  Map(&pass.correction[row * pass.states], n) = share * delta_;
  Map(&pass.filtered[row * pass.states], n) = x_;
}

bool SiteFilter::try_flow(size_t row, const SitePass& pass, const double* from, double* to) {
  model_.put_modes_back(row, &pass.modes[row * model_.mode_bytes()]);
  return model_.flow(row, from, to);
}

void SiteFilter::choose_substeps(const SitePass& pass, double difference) {
  constexpr size_t places = 40, most = 64;
  const auto differs = [&](size_t row) {
    const double* from = &pass.filtered[row * pass.states];
    const int count = model_.substeps();
    const bool good = try_flow(row, pass, from, next_.data());
    model_.set_substeps(2 * count);
    const bool finer_good = try_flow(row, pass, from, moved_next_.data());
    model_.set_substeps(count);
    if (!good || !finer_good) return finer_good;
    for (size_t i = 0; i < model_states_; ++i)
      if (std::abs(next_[Eigen::Index(i)] - moved_next_[Eigen::Index(i)]) > difference * state_scale_[i])
        return true;
    return false;
  };
  const size_t apart = std::max<size_t>(1, pass.rows / places);
  for (size_t row = 0; row + 1 < pass.rows; row += apart)
    while (size_t(model_.substeps()) < most && differs(row)) model_.set_substeps(2 * model_.substeps());
}

bool SiteFilter::correct(size_t row, const SiteNoise& noise, SitePass& pass) {
  const Eigen::Index n = Eigen::Index(pass.states);
  if (!model_.outputs(row, x_.data(), y_.data()) || !slopes_of_outputs(row, pass)) return false;
  add_slow_errors(noise);
  delta_.setZero();
  for (size_t j = 0; j < pass.outputs; ++j) {
    const size_t at = row * pass.outputs + j;
    const ConstMap C(&pass.C[at * pass.states], n);
    Map K(&pass.gain[at * pass.states], n);
    const double innovation = record_.outputs[j].value[row] - y_[j];
    pass.innovation[at] = innovation;
    if (!std::isfinite(y_[j])) return false;
    if (!std::isfinite(innovation)) {
      pass.error[at] = missing, pass.variance[at] = 1;
      K.setZero();
      continue;
    }
    gain_.noalias() = P_ * C;
    const double S = C.dot(gain_) + squared(noise.measurement[j]);
    const double e = innovation - C.dot(delta_);
    K = gain_ / S;
    P_.noalias() -= gain_ * K.transpose();
    delta_ += e * K;
    pass.error[at] = e, pass.variance[at] = S;
    pass.log_variances += std::log(S), pass.squares += e * e / S;
    ++pass.readings;
  }
  x_ += delta_;
  return true;
}

void SiteFilter::predict_covariance(const SitePass& pass, size_t row, const SiteNoise& noise) {
  const size_t n = pass.states;
  const Eigen::Map<const Eigen::MatrixXd> A(&pass.A[row * n * n], Eigen::Index(n), Eigen::Index(n));
  product_.noalias() = A * P_;
  P_.noalias() = product_ * A.transpose();
  const double shorter = record_.sample_time / record_.step(row);
  for (size_t s = 0; s < noise.sites.size(); ++s) {
    const ConstMap G(&pass.G[(row * pass.sites + size_t(noise.sites[s])) * n], Eigen::Index(n));
    P_.noalias() += (shorter * squared(deviation_at(pass, row, noise, s))) * G * G.transpose();
  }
  for (size_t j = 0; j < noise.slow.size(); ++j) {
    const auto i = Eigen::Index(model_states_ + j);
    P_(i, i) += squared(noise.slow[j].size) * (1 - squared(noise.slow[j].kept(record_.step(row))));
  }
  product_ = P_.transpose();
  P_ = 0.5 * (P_ + product_);
}

bool SiteFilter::run(size_t rows, const SiteNoise& noise, bool with_columns, SitePass& pass) {
  pass.noise = noise;
  allocate(rows, with_columns, pass);
  choose_changes(noise, pass);
  pass.log_variances = pass.squares = 0, pass.readings = 0;
  for (size_t row = 0; row < rows; ++row) {
    if (record_.begins_at(row)) {
      begin_at(row);
      begin_covariance(noise);
    }
    end_ = {row, x_};  // until the row is left
    if (!correct(row, noise, pass)) return false;
    model_.keep_modes(row, modes_at(pass, row));
    end_.states = x_;
    double share = 1;
    if (!advance_from_correction(row, pass, with_columns ? middle_.data() : nullptr, share, &slopes_))
      return false;
    keep_correction(row, share, pass);
    if (!linearize(row, noise, pass)) return false;
    predict_covariance(pass, row, noise);
    x_ = next_;
  }
  return std::isfinite(pass.objective());
}

bool SiteFilter::run_frozen(const SitePass& gains, std::span<double> error) {
  const size_t n = gains.states;
  for (Eigen::VectorXd* v : {&x_, &next_, &delta_}) v->setZero(Eigen::Index(n));
  for (size_t row = 0; row < gains.rows; ++row) {
    if (record_.begins_at(row)) begin_at(row);
    if (!model_.outputs(row, x_.data(), y_.data())) return false;
    add_slow_errors(gains.noise);
    delta_.setZero();
    for (size_t j = 0; j < gains.outputs; ++j) {
      const size_t at = row * gains.outputs + j;
      if (std::isnan(gains.error[at])) {
        error[at] = missing;
        continue;
      }
      error[at] =
          record_.outputs[j].value[row] - y_[j] - ConstMap(&gains.C[at * n], Eigen::Index(n)).dot(delta_);
      delta_ += error[at] * ConstMap(&gains.gain[at * n], Eigen::Index(n));
    }
    if (gains.share[row] < 1) delta_ *= gains.share[row];
    x_ += delta_;
    double share = 1;
    if (!advance_from_correction(row, gains, nullptr, share)) return false;
    x_ = next_;
  }
  return true;
}

}  // namespace loopwright::diagnosis
