#include "tools/effects/step_maps.h"
#include <algorithm>
#include <array>

namespace loopwright {
namespace {

/// [of a state] A smaller change is lost in its digits, as that of a position far from zero.
constexpr double least_difference = 1.5e-8;

/// Mean of the force over a sample and its slope, from its means over steps: ∫ (u - ½) f du, in which the
/// force of a step acts at its middle.
template <class Vector> struct MeanAndSlope {
  Vector mean, moment;
  void add(const Vector& force, double begin, double length) {
    mean += length * force, moment += (begin + 0.5 * length - 0.5) * length * force;
  }
  Vector slope() const { return 12 * moment; }
};

}  // namespace

StepMaps::StepMaps(EffectSample& sample, const EffectSample::Body& body,
                   const std::vector<double>& differences, std::unique_ptr<StepMaps> finer)
    : sample_(sample),
      body_(body),
      states_(Eigen::Index(differences.size()) - GivenSignals::count),
      finer_(std::move(finer)) {
  using enum GivenSignals::Index;
  const auto of_signal = [&](GivenSignals::Index i) { return differences[size_t(states_) + i]; };
  differences_.resize(states_ + 4);
  for (Eigen::Index i = 0; i < states_; ++i) differences_[i] = differences[size_t(i)];
  differences_.tail(4) << of_signal(position), of_signal(velocity), body.inertia * of_signal(acceleration),
      of_signal(acceleration);
  z_.resize(states_ + 4), next_.resize(states_ + 3), instant_.states.resize(size_t(states_));
}

bool StepMaps::integrate(const Eigen::VectorXd& z, const std::string& decided, Eigen::VectorXd& next) {
  const Eigen::Index n = states_;
  std::copy_n(z.data(), n, instant_.states.begin());
  instant_.position = z[n], instant_.velocity = z[n + 1], instant_.push = z[n + 2];
  sample_.step_against(body_, z[n + 3], instant_);
  next.resize(n + 3);
  std::ranges::copy(instant_.states, next.data());
  next.tail(3) << instant_.position, instant_.velocity, instant_.push;
  return sample_.decided() == decided;
}

const StepMaps::StepMap* StepMaps::map_at(const Eigen::VectorXd& z, const GivenSignals& given) {
  using enum GivenSignals::Index;
  const Eigen::Index n = states_;
  std::copy_n(z.data(), n, instant_.states.begin());
  GivenSignals now = given;
  now.value[position] = z[n], now.value[velocity] = z[n + 1];
  now.value[acceleration] = now.value[velocity_slope] = z[n + 3] - z[n + 2] / body_.inertia;
  const std::string& key = sample_.decide(instant_.states, now);
  if (const auto known = maps_.find(key); known != maps_.end()) return &known->second;
  const std::string decided = key;
  StepMap map{z, {}, Eigen::MatrixXd::Zero(n + 3, n + 4)};
  integrate(z, decided, map.to);
  Eigen::VectorXd there(n + 3);
  for (Eigen::Index c = 0; c < n + 4; ++c) {
    if (differences_[c] == 0) continue;
    const auto differ = [&](double by) {
      Eigen::VectorXd changed = z;
      changed[c] += by;
      if (!integrate(changed, decided, there)) return false;
      map.slopes.col(c) = (there - map.to) / by;
      return true;
    };
    const double by = std::max(differences_[c], least_difference * std::abs(z[c]));
    if (!differ(by) && !differ(-by)) return nullptr;
  }
  return &maps_.emplace(decided, std::move(map)).first->second;
}

bool StepMaps::take(size_t steps, double begin, const GivenSignals& given, Eigen::VectorXd& z,
                    std::vector<Taken>& taken) {
  const Eigen::Index n = states_;
  const double length = 1.0 / sample_.steps();
  const StepMap* map = map_at(z, given);
  for (size_t step = 0; step < steps; ++step) {
    if (!map) return false;
    before_ = z;
    next_ = map->to + map->slopes.lazyProduct(z - map->from);
    z.head(n + 3) = next_;
    taken.push_back({map, begin + double(step) * length, length, next_[n + 2]});
    const StepMap* after = map_at(z, given);
    if (finer_ && after != map && take_again(before_, given, z, taken)) after = map_at(z, given);
    map = after;
  }
  return true;
}

bool StepMaps::take_again(const Eigen::VectorXd& before, const GivenSignals& given, Eigen::VectorXd& z,
                          std::vector<Taken>& taken) {
  const Taken whole = taken.back();
  const size_t others = taken.size() - 1;
  taken.pop_back();
  Eigen::VectorXd there = before;
  const size_t steps = size_t(finer_->sample_.steps() / sample_.steps());
  if (finer_->take(steps, whole.begin, given, there, taken)) return z = there, true;
  taken.resize(others), taken.push_back(whole);
  return false;
}

bool StepMaps::follow(const std::vector<double>& states, const GivenSignals& given,
                      std::vector<double>& result) {
  using enum GivenSignals::Index;
  const Eigen::Index n = states_;
  std::ranges::copy(states, z_.data());
  z_.tail(4) << given[position], given[velocity], 0, given[acceleration];
  taken_.clear();
  if (!take(size_t(sample_.steps()), 0, given, z_, taken_)) return false;
  MeanAndSlope<double> pushes{0, 0};
  for (const Taken& step : taken_) pushes.add(step.push, step.begin, step.length);
  result.assign(z_.data(), z_.data() + n);
  result.push_back(pushes.mean), result.push_back(pushes.slope());
  return true;
}

void StepMaps::differentiate(SampleMap& map) {
  using enum GivenSignals::Index;
  const Eigen::Index n = states_, inputs = n + 3;  // states, position, velocity, free acceleration
  slopes_.setZero(n + 4, inputs);                  // of z
  slopes_.topLeftCorner(n + 2, n + 2).setIdentity(), slopes_(n + 3, n + 2) = 1;
  MeanAndSlope<Eigen::RowVectorXd> pushes{Eigen::RowVectorXd::Zero(inputs), Eigen::RowVectorXd::Zero(inputs)};
  for (const Taken& step : taken_) {
    next_slopes_ = step.map->slopes.lazyProduct(slopes_);
    slopes_.topRows(n + 3) = next_slopes_;
    pushes.add(slopes_.row(n + 2), step.begin, step.length);
  }
  const Eigen::RowVectorXd &mean = pushes.mean, slope = pushes.slope();
  map = {size_t(n), std::vector(size_t(n) + GivenSignals::count, std::vector<double>(size_t(n) + 2))};
  for (Eigen::Index c = 0; c < inputs; ++c) {
    std::vector<double>& column =
        map.columns[size_t(c < n ? c : n + std::array{position, velocity, acceleration}[size_t(c - n)])];
    std::copy_n(slopes_.col(c).data(), n, column.begin());
    column[size_t(n)] = mean[c], column[size_t(n) + 1] = slope[c];
  }
}

}  // namespace loopwright
