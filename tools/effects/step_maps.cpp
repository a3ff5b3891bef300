#include "tools/effects/step_maps.h"
#include <algorithm>
#include <array>

namespace loopwright {
namespace {

/// [of a state] A smaller change is lost in its digits, as that of a position far from zero.
constexpr double least_difference = 1.5e-8;

/// Mean of the force over a sample and its slope, from its means over equal steps: ∫ (u - ½) f du, in which
/// the force of a step acts at its middle.
template <class Vector> class MeanAndSlope {
 public:
  MeanAndSlope(const Vector& zero, size_t steps) : steps_(double(steps)), sum_(zero), moment_(zero) {}
  void add(const Vector& force, size_t step) {
    sum_ += force, moment_ += ((double(step) + 0.5) / steps_ - 0.5) * force;
  }
  Vector mean() const { return sum_ / steps_; }
  Vector slope() const { return 12 * moment_ / steps_; }

 private:
  double steps_;
  Vector sum_, moment_;
};

}  // namespace

StepMaps::StepMaps(EffectSample& sample, const EffectSample::Body& body,
                   const std::vector<double>& differences)
    : sample_(sample), body_(body), states_(Eigen::Index(differences.size()) - GivenSignals::count) {
  using enum GivenSignals::Index;
  const auto of_signal = [&](GivenSignals::Index i) { return differences[size_t(states_) + i]; };
  differences_.resize(states_ + 4);
  for (Eigen::Index i = 0; i < states_; ++i) differences_[i] = differences[size_t(i)];
  differences_.tail(4) << of_signal(position), of_signal(velocity), body.inertia * of_signal(acceleration),
      of_signal(acceleration);
  z_.resize(states_ + 4), next_.resize(states_ + 3), instant_.states.resize(size_t(states_));
  taken_.reserve(size_t(sample.steps()));
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

bool StepMaps::follow(const std::vector<double>& states, const GivenSignals& given,
                      std::vector<double>& result) {
  using enum GivenSignals::Index;
  const Eigen::Index n = states_;
  const size_t steps = size_t(sample_.steps());
  std::ranges::copy(states, z_.data());
  z_.tail(4) << given[position], given[velocity], 0, given[acceleration];
  MeanAndSlope<double> pushes(0, steps);
  taken_.clear();
  for (size_t step = 0; step < steps; ++step) {
    const StepMap* map = map_at(z_, given);
    if (!map) return false;
    taken_.push_back(map);
    z_ -= map->from;
    next_ = map->to + map->slopes.lazyProduct(z_);
    z_.head(n + 3) = next_, z_[n + 3] = given[acceleration];
    pushes.add(next_[n + 2], step);
  }
  result.assign(next_.data(), next_.data() + n);
  result.push_back(pushes.mean()), result.push_back(pushes.slope());
  return true;
}

void StepMaps::differentiate(SampleMap& map) {
  using enum GivenSignals::Index;
  const Eigen::Index n = states_, inputs = n + 3;  // states, position, velocity, free acceleration
  slopes_.setZero(n + 4, inputs);                  // of z
  slopes_.topLeftCorner(n + 2, n + 2).setIdentity(), slopes_(n + 3, n + 2) = 1;
  MeanAndSlope<Eigen::RowVectorXd> pushes(Eigen::RowVectorXd::Zero(inputs), taken_.size());
  for (size_t step = 0; step < taken_.size(); ++step) {
    next_slopes_ = taken_[step]->slopes.lazyProduct(slopes_);
    slopes_.topRows(n + 3) = next_slopes_;
    pushes.add(slopes_.row(n + 2), step);
  }
  const Eigen::RowVectorXd mean = pushes.mean(), slope = pushes.slope();
  map = {size_t(n), std::vector(size_t(n) + GivenSignals::count, std::vector<double>(size_t(n) + 2))};
  for (Eigen::Index c = 0; c < inputs; ++c) {
    std::vector<double>& column =
        map.columns[size_t(c < n ? c : n + std::array{position, velocity, acceleration}[size_t(c - n)])];
    std::copy_n(slopes_.col(c).data(), n, column.begin());
    column[size_t(n)] = mean[c], column[size_t(n) + 1] = slope[c];
  }
}

}  // namespace loopwright
