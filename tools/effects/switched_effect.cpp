#include "tools/effects/switched_effect.h"
#include <algorithm>
#include <cmath>
#include <random>

namespace loopwright {
namespace {

/// [top speed] A change of the velocity for a difference, and of the position in a sample: a decision within
/// the sample is linear enough for it, and rounding is far smaller.
constexpr double small_share = 1e-3;
/// Samples that are tried, from states and signals of every size, and how well the maps of a mode agree: of
/// the largest number of their kind.
constexpr int tried_for_modes = 200;
constexpr double agreement = 1e-5;

/// Whether the maps of each mode are the same, each number compared with the largest of its kind.
bool are_alike(const std::map<std::string, std::vector<SampleMap>>& modes) {
  const SampleMap& any = modes.begin()->second.front();
  for (size_t c = 0; c < any.columns.size(); ++c)
    for (size_t i = 0; i < any.columns[c].size(); ++i) {
      double largest = 0, farthest = 0;
      for (const auto& [mode, maps] : modes)
        for (const SampleMap& map : maps) {
          largest = std::max(largest, std::abs(map.columns[c][i]));
          farthest = std::max(farthest, std::abs(map.columns[c][i] - maps.front().columns[c][i]));
        }
      if (!(farthest <= agreement * largest)) return false;
    }
  return true;
}

}  // namespace

SwitchedSample::SwitchedSample(std::shared_ptr<const EffectPlan> plan, const std::vector<double>& fitted)
    : plan_(plan->finer ? plan->finer : std::move(plan)), fitted_(fitted), sample_(plan_) {
  const std::vector<double> origin = start(0, 0), ahead = start(1, 0), faster = start(0, 1);
  for (size_t i = 0; i < origin.size(); ++i)
    follows_.push_back({ahead[i] - origin[i], faster[i] - origin[i]});
}

std::vector<double> SwitchedSample::start(double position, double velocity) {
  sample_.start(fitted_, position, velocity);
  return sample_.states();
}

bool SwitchedSample::differ(const std::vector<double>& states, const GivenSignals& given, double size,
                            SampleMap& map) {
  using enum GivenSignals::Index;
  const double period = plan_->sizes.sample_time, of_velocity = size, of_position = size * period;
  std::vector<double> changed = states;
  GivenSignals changed_given = given;
  const std::string decided = sample_.decided();
  bool decides_alike = !sample_.decided_anew();
  map = {states.size(), std::vector(states.size() + count, std::vector<double>(states.size() + 2))};
  const auto take = [&](double& number, double by, std::vector<double>& column) {
    if (by == 0) return;
    const double before = number;
    const auto at = [&](double value) {
      number = value;
      std::vector<double> result = sample_.against(body_, changed, changed_given);
      decides_alike &= sample_.decided() == decided && !sample_.decided_anew();
      return result;
    };
    column = at(before + by);
    const std::vector<double> low = at(before - by);
    number = before;
    for (size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - low[i]) / (2 * by);
  };
  for (size_t i = 0; i < states.size(); ++i)
    take(changed[i],
         std::abs(follows_[i].position) * of_position + std::abs(follows_[i].velocity) * of_velocity,
         map.columns[i]);
  take(changed_given.value[position], of_position, map.columns[states.size() + position]);
  take(changed_given.value[velocity], of_velocity, map.columns[states.size() + velocity]);
  take(changed_given.value[acceleration], of_velocity / period, map.columns[states.size() + acceleration]);
  return decides_alike;
}

bool SwitchedSample::follow(const Mode& mode, const std::vector<double>& states, const GivenSignals& given) {
  using enum GivenSignals::Index;
  const std::vector<std::vector<double>>& columns = maps_[mode.map].columns;
  const size_t own = states.size();
  result_ = mode.result;
  const auto add = [&](const std::vector<double>& column, double by) {
    for (size_t i = 0; i < result_.size(); ++i) result_[i] += by * column[i];
  };
  for (size_t i = 0; i < own; ++i) add(columns[i], states[i] - mode.states[i]);
  for (const auto signal : {position, velocity, acceleration})
    add(columns[own + signal], given[signal] - mode.given[signal]);
  ends_.assign(result_.begin(), result_.begin() + std::ptrdiff_t(own));
  const double period = plan_->sizes.sample_time, gain = given[acceleration] - result_[own] / body_.inertia;
  GivenSignals at_end = given;
  at_end.value[position] += period * (given[velocity] + 0.5 * period * gain);
  at_end.value[velocity] += period * gain;
  const std::string decided = sample_.decided();
  return sample_.decide(ends_, at_end) == decided;
}

const std::vector<double>& SwitchedSample::from(const std::vector<double>& states,
                                                const GivenSignals& given) {
  followed_ = nullptr;
  const auto mode = modes_.find(sample_.decide(states, given));
  if (mode != modes_.end() && follow(mode->second, states, given)) {
    followed_ = &mode->second;
    return result_;
  }
  result_ = sample_.against(body_, states, given);
  if (mode != modes_.end() || sample_.decided_anew()) return result_;
  const std::string decided = sample_.decided();
  SampleMap map;
  if (!differ(states, given, small_share * plan_->sizes.top_speed, map)) return result_;
  maps_.push_back(std::move(map));
  followed_ =
      &modes_.try_emplace(decided, Mode{states, given, result_, uint32_t(maps_.size() - 1)}).first->second;
  return result_;
}

uint32_t SwitchedSample::map_of(const std::vector<double>& states, const GivenSignals& given) {
  if (followed_) return followed_->map;
  differ(states, given, small_share * plan_->sizes.top_speed, maps_.emplace_back());
  return uint32_t(maps_.size() - 1);
}

bool is_switched(const std::shared_ptr<const EffectPlan>& plan) {
  if (!plan->flies || plan->is_linear || plan->acts_on_sensor) return false;
  std::vector<double> fitted;
  for (const EffectParameter& p : plan->effect.parameters)
    if (p.is_fitted) fitted.push_back(range_of(p, plan->sizes).start);
  SwitchedSample sample(plan, fitted);
  const bool follows = std::ranges::all_of(
      sample.follows(), [](const auto& state) { return state.position != 0 || state.velocity != 0; });
  if (!follows) return false;
  sample.start(0, 0);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> magnitude(-8, 0), share(-1, 1);
  std::map<std::string, std::vector<SampleMap>> modes;
  for (int i = 0; i < tried_for_modes; ++i) {
    const double size = std::pow(10, magnitude(random));
    GivenSignals given;
    std::vector<double> states(sample.follows().size());
    for (double& x : states) x = size * share(random);
    for (double& u : given.value) u = size * share(random);
    sample.sample_.against(sample.body_, states, given);
    const std::string decided = sample.sample_.decided();
    SampleMap map;
    if (sample.differ(states, given, small_share * size, map)) modes[decided].push_back(std::move(map));
  }
  return modes.size() > 1 && are_alike(modes);
}

}  // namespace loopwright
