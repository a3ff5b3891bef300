#include "tools/effects/switched_effect.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace loopwright {
namespace {

/// [top speed] A change of the velocity for a difference, and of the position in a sample: a decision within
/// the sample is linear enough for it, and rounding is far smaller.
constexpr double small_share = 1e-3;
/// Samples that are tried, from states and signals of every size, and how well the maps of a mode agree: of
/// what the usual differences change most.
constexpr int tried_for_modes = 200;
constexpr double agreement = 1e-5;
/// The same for steps that are long, but resolve the effect.
constexpr double long_steps = 0.3;

}  // namespace

SwitchedSample::SwitchedSample(std::shared_ptr<const EffectPlan> plan, const std::vector<double>& fitted)
    : plan_(plan->finer ? plan->finer : std::move(plan)), fitted_(fitted), sample_(plan_) {
  if (plan_->finer) finer_ = std::make_unique<EffectSample>(plan_->finer);
  const std::vector<double> origin = start(0, 0), ahead = start(1, 0), faster = start(0, 1);
  for (size_t i = 0; i < origin.size(); ++i)
    follows_.push_back({ahead[i] - origin[i], faster[i] - origin[i]});
}

std::vector<double> SwitchedSample::start(double position, double velocity) {
  sample_.start(fitted_, position, velocity);
  if (finer_) finer_->start(fitted_, position, velocity);
  return sample_.states();
}

void SwitchedSample::set_body(const EffectSample::Body& body) {
  body_ = body;
  steps_.reset();
  if (sample_.steps() == 0) return;
  const std::vector<double> by = differences(small_share * plan_->sizes.top_speed);
  auto finer =
      finer_ && finer_->steps() > 0 ? std::make_unique<StepMaps>(*finer_, body, by, nullptr) : nullptr;
  steps_.emplace(sample_, body, by, std::move(finer));
}

std::vector<double> SwitchedSample::integrated(const std::vector<double>& states, const GivenSignals& given) {
  return body_ ? sample_.against(*body_, states, given) : sample_.from(states, given);
}

GivenSignals SwitchedSample::at_end(const GivenSignals& given, double mean_force) const {
  using enum GivenSignals::Index;
  const double period = plan_->sizes.sample_time;
  const double gain = body_ ? given[acceleration] - mean_force / body_->inertia : given[velocity_slope];
  GivenSignals end = given;
  end.value[position] += period * (given[velocity] + 0.5 * period * gain);
  end.value[velocity] += period * gain;
  if (!body_) end.value[acceleration] += period * given[acceleration_slope];
  return end;
}

std::vector<double> SwitchedSample::differences(double size) const {
  using enum GivenSignals::Index;
  const double period = plan_->sizes.sample_time;
  std::vector<double> list;
  for (const Follows& state : follows_)
    list.push_back((std::abs(state.position) * period + std::abs(state.velocity)) * size);
  GivenSignals given;
  given.value[position] = size * period, given.value[velocity] = size;
  given.value[acceleration] = size / period;
  if (!body_) {  // against() derives them
    given.value[velocity_slope] = size / period;
    given.value[acceleration_slope] = size / (period * period);
  }
  list.insert(list.end(), given.value.begin(), given.value.end());
  return list;
}

bool SwitchedSample::differ(const std::vector<double>& states, const GivenSignals& given,
                            const std::vector<double>& result, double size, SampleMap& map) {
  std::vector<double> changed = states;
  GivenSignals changed_given = given;
  const std::string decided = sample_.decided();
  bool decides_alike = !sample_.decided_anew();
  map = {states.size(), {}};
  for (const double by : differences(size)) {
    const size_t c = map.columns.size(), own = states.size();
    std::vector<double>& column = map.columns.emplace_back(own + 2);
    if (by == 0) continue;
    double& number = c < own ? changed[c] : changed_given.value[c - own];
    const double before = number;
    number += by;
    column = integrated(changed, changed_given);
    number = before;
    decides_alike &= sample_.decided() == decided && !sample_.decided_anew();
    for (size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - result[i]) / by;
  }
  return decides_alike;
}

bool SwitchedSample::follow(const Mode& mode, const std::vector<double>& states, const GivenSignals& given) {
  using enum GivenSignals::Index;
  const std::vector<std::vector<double>>& columns = maps_[mode.map].columns;
  const size_t own = states.size();
  result_ = mode.result;
  const auto add = [&](const std::vector<double>& column, double by) {
    if (by == 0) return;
    for (size_t i = 0; i < result_.size(); ++i) result_[i] += by * column[i];
  };
  for (size_t i = 0; i < own; ++i) add(columns[i], states[i] - mode.states[i]);
  for (size_t i = 0; i < given.value.size(); ++i) add(columns[own + i], given.value[i] - mode.given.value[i]);
  ends_.assign(result_.begin(), result_.begin() + std::ptrdiff_t(own));
  const std::string decided = sample_.decided();
  return sample_.decide(ends_, at_end(given, result_[own])) == decided;
}

const std::vector<double>& SwitchedSample::from(const std::vector<double>& states,
                                                const GivenSignals& given) {
  followed_ = nullptr, in_steps_ = false;
  const auto mode = modes_.find(sample_.decide(states, given));
  if (mode != modes_.end() && follow(mode->second, states, given)) {
    followed_ = &mode->second;
    return result_;
  }
  if (mode != modes_.end() && steps_ && (in_steps_ = steps_->follow(states, given, result_))) return result_;
  result_ = integrated(states, given);
  if (mode != modes_.end() || sample_.decided_anew()) return result_;
  const std::string decided = sample_.decided();
  SampleMap map;
  if (!differ(states, given, result_, small_share * plan_->sizes.top_speed, map)) return result_;
  maps_.push_back(std::move(map));
  followed_ =
      &modes_.try_emplace(decided, Mode{states, given, result_, uint32_t(maps_.size() - 1)}).first->second;
  return result_;
}

uint32_t SwitchedSample::map_of(const std::vector<double>& states, const GivenSignals& given) {
  if (followed_) return followed_->map;
  SampleMap& map = maps_.emplace_back();
  if (in_steps_)
    steps_->differentiate(map);
  else
    differ(states, given, result_, small_share * plan_->sizes.top_speed, map);
  return uint32_t(maps_.size() - 1);
}

SwitchedSample::Modes SwitchedSample::modes_of(const std::shared_ptr<const EffectPlan>& plan) {
  std::vector<double> fitted;
  for (const EffectParameter& p : plan->effect.parameters)
    if (p.is_fitted) fitted.push_back(range_of(p, plan->sizes).start);
  SwitchedSample sample(plan, fitted);
  Modes modes{sample.follows().size(), sample.differences(1), {}};
  const bool follows = std::ranges::all_of(
      sample.follows(), [](const auto& state) { return state.position != 0 || state.velocity != 0; });
  if (!follows) return modes;
  sample.start(0, 0);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> magnitude(-8, 0), share(-1, 1);
  for (int i = 0; i < tried_for_modes; ++i) {
    const double size = std::pow(10, magnitude(random));
    GivenSignals given;
    std::vector<double> states(modes.states);
    for (double& x : states) x = size * share(random);
    for (double& u : given.value) u = size * share(random);
    const std::vector<double> result = sample.integrated(states, given);
    const std::string decided = sample.sample_.decided();
    SampleMap map;
    if (sample.differ(states, given, result, small_share * size, map))
      modes.maps[decided].push_back(std::move(map));
  }
  return modes;
}

double SwitchedSample::Modes::apart(const Modes& other) const {
  double most = 0;
  for (size_t i = 0; i < states + 1; ++i) {
    double largest = 0, farthest = 0;
    for (const auto& [mode, own] : maps) {
      const auto there = other.maps.find(mode);
      if (there == other.maps.end()) return std::numeric_limits<double>::infinity();
      for (const SampleMap& map : own)
        for (size_t c = 0; c < differences.size(); ++c) {
          const double reference = there->second.front().columns[c][i];
          largest = std::max(largest, std::abs(differences[c] * reference));
          farthest = std::max(farthest, std::abs(differences[c] * (map.columns[c][i] - reference)));
        }
    }
    most = std::max(most, largest > 0 ? farthest / largest : 0);
  }
  return most;
}

bool is_switched(const std::shared_ptr<const EffectPlan>& plan) {
  const std::vector<std::string>& reads = plan->effect.reads;
  const bool is_moved_alone =
      std::ranges::find(reads, "input") == reads.end() && std::ranges::find(reads, "force") == reads.end();
  if (!plan->flies || plan->is_linear || plan->acts_on_sensor || !is_moved_alone) return false;
  const SwitchedSample::Modes modes = SwitchedSample::modes_of(plan);
  return modes.maps.size() > 1 && modes.apart(modes) <= agreement;
}

bool resolves(const std::shared_ptr<const EffectPlan>& steps, const std::shared_ptr<const EffectPlan>& plan) {
  return SwitchedSample::modes_of(steps).apart(SwitchedSample::modes_of(plan)) <= long_steps;
}

}  // namespace loopwright
