#include "tools/effects/linear_effect.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <random>
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// Samples that are tried with each set of parameters, of magnitudes from 10^-6 to 10^3: a threshold, a
/// friction or a square shows at one of them.
constexpr int tried_samples = 48;
/// Of the sum of the magnitudes of all terms; rounding leaves less than 1e-12.
constexpr double tolerance = 1e-9;

bool remembers_only_states(const EffectPlan& effect) {
  return std::ranges::all_of(effect.plan.blocks, [](const Plan::Block& block) {
    const BlockInfo& info = block.type->info;
    if (info.type == "ExternalSignal") return true;
    const bool switches = !info.crossings.empty() && info.type != "Integrator";
    return !info.is_sampled && !info.uses_time && info.buffers == 0 && info.memory_numbers.empty() &&
           !switches;
  });
}

/// Superposition, tried with the present parameters.
bool superposes(EffectSample& sample, std::mt19937_64& random) {
  const SampleMap map = sample.map();
  std::uniform_real_distribution<double> magnitude(-6, 3), share(-1, 1);
  std::vector<double> before(map.states), expected;
  for (int i = 0; i < tried_samples; ++i) {
    const double size = std::pow(10, magnitude(random));
    GivenSignals given;
    for (double& x : before) x = size * share(random);
    for (double& u : given.value) u = size * share(random);
    map.apply(before, given, expected);
    const std::vector<double> result = sample.from(before, given);
    for (size_t row = 0; row < result.size(); ++row) {
      double terms = 0;
      for (size_t c = 0; c < map.columns.size(); ++c)
        terms += std::abs(map.columns[c][row] * (c < map.states ? before[c] : given.value[c - map.states]));
      if (!(std::abs(result[row] - expected[row]) <= tolerance * terms)) return false;
    }
  }
  return true;
}

}  // namespace

void SampleMap::apply(const std::vector<double>& before, const GivenSignals& given,
                      std::vector<double>& result) const {
  result.assign(states + 2, 0.0);
  for (size_t c = 0; c < columns.size(); ++c) {
    const double factor = c < states ? before[c] : given.value[c - states];
    if (factor == 0) continue;
    for (size_t row = 0; row < result.size(); ++row) result[row] += factor * columns[c][row];
  }
}

SampleMaps::SampleMaps(std::span<const SampleMap> maps, std::span<const std::vector<double>> states)
    : states_(maps.front().states),
      sets_(maps.size()),
      before_(states_ * sets_),
      result_((states_ + 2) * sets_) {
  for (size_t c = 0; c < maps.front().columns.size(); ++c)
    for (size_t row = 0; row < states_ + 2; ++row)
      for (const SampleMap& map : maps) matrix_.push_back(map.columns[c][row]);
  for (size_t i = 0; i < states_; ++i)
    for (size_t set = 0; set < sets_; ++set) before_[i * sets_ + set] = states[set][i];
}

void SampleMaps::step(const GivenSignals& given) {
  std::ranges::fill(result_, 0.0);
  const double* column = matrix_.data();
  for (size_t c = 0; c < states_; ++c, column += result_.size())
    for (size_t row = 0; row < states_ + 2; ++row)
      for (size_t set = 0; set < sets_; ++set)
        result_[row * sets_ + set] += before_[c * sets_ + set] * column[row * sets_ + set];
  for (size_t c = 0; c < given.value.size(); ++c, column += result_.size()) {
    const double factor = given.value[c];
    if (factor == 0) continue;
    for (size_t i = 0; i < result_.size(); ++i) result_[i] += factor * column[i];
  }
  std::copy_n(result_.begin(), before_.size(), before_.begin());
}

EffectSample::EffectSample(std::shared_ptr<const EffectPlan> plan)
    : plan_(std::move(plan)),
      run_(plan_->plan),
      sample_ticks_(int64_t(whole_count(std::round(plan_->sizes.sample_time / plan_->plan.clock.time(1))))) {
  using enum GivenSignals::Index;
  for (const EffectPlan::Binding& binding : plan_->bindings) bound_.push_back(run_.parameter(binding.path));
  wire("position", position, velocity, true, 0.5), wire("velocity", velocity, velocity_slope, true, 0);
  wire("acceleration", acceleration, acceleration_slope, true, 0);
  wire("input", input, input, false, 0), wire("force", force, force, false, 0);
  for (int i = 0; i < plan_->plan.states; ++i)
    if (plan_->plan.signals + i != plan_->integral) states_.push_back(size_t(i));
  for (size_t block = 0; block < plan_->plan.blocks.size(); ++block)
    if (const size_t size = plan_->plan.blocks[block].type->kernels.mode_size)
      modes_.push_back({static_cast<const char*>(run_.call(int(block)).mode), size});
}

void EffectSample::wire(const char* role, GivenSignals::Index value, GivenSignals::Index slope, bool is_line,
                        double bend_factor) {
  const auto number = [&](const char* name) {
    return run_.parameter(fmt::format("given_{}.{}", role, name));
  };
  if (!number("value")) return;
  wires_.push_back({number("value"), value, 1}), since_.push_back(number("since"));
  if (is_line) wires_.push_back({number("slope"), slope, 1});
  if (bend_factor > 0) wires_.push_back({number("bend"), GivenSignals::velocity_slope, bend_factor});
}

void EffectSample::start(const std::vector<double>& fitted, double position, double velocity) {
  RecordSizes sizes = plan_->sizes;
  sizes.initial_position = position, sizes.initial_velocity = velocity;
  const EffectValues values = values_of(plan_->effect, sizes, fitted);
  for (size_t i = 0; i < bound_.size(); ++i) *bound_[i] = values.evaluate(plan_->bindings[i].value);
  run_.reset({});
}

std::vector<double> EffectSample::states() {
  std::vector<double> list;
  for (const size_t i : states_) list.push_back(run_.states()[i]);
  return list;
}

void EffectSample::note_decisions(bool is_start) {
  if (is_start) decided_.clear();
  size_t at = 0;
  for (const Mode& mode : modes_) {
    if (is_start)
      decided_.append(mode.bytes, mode.size);
    else
      decided_anew_ |= decided_.compare(at, mode.size, mode.bytes, mode.size) != 0;
    at += mode.size;
  }
  if (is_start) decided_anew_ = false;
}

void EffectSample::set_states(const std::vector<double>& states) {
  std::ranges::fill(run_.states(), 0.0);
  for (size_t i = 0; i < states_.size(); ++i) run_.states()[states_[i]] = states[i];
}

void EffectSample::give(const GivenSignals& given) {
  for (const Wire& wire : wires_) *wire.number = wire.factor * given[wire.signal];
  for (double* since : since_) *since = run_.now().time;
}

void EffectSample::evaluate() {
  const uint64_t due = run_.due();
  run_.evaluate(due, true), run_.accept(), run_.update(due);
}

const std::string& EffectSample::decide(const std::vector<double>& states, const GivenSignals& given) {
  set_states(states), give(given), evaluate();
  note_decisions(true);
  return decided_;
}

int EffectSample::steps() const {
  const int64_t step = std::min(plan_->plan.step_ticks, sample_ticks_);
  return sample_ticks_ % step == 0 ? int(sample_ticks_ / step) : 0;
}

double EffectSample::push_body(const Body& body, double free_acceleration, int64_t ticks, bool is_start,
                               GivenSignals& now, double push) {
  constexpr int rounds = 2;  // the force of a step and the acceleration in it depend on each other
  using enum GivenSignals::Index;
  const int64_t begins = run_.now().tick;
  const double step = plan_->sizes.sample_time * double(ticks) / double(sample_ticks_);
  before_.assign(run_.states().begin(), run_.states().end());
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) std::ranges::copy(before_, run_.states().begin()), run_.move_to(begins);
    now.value[acceleration] = now.value[velocity_slope] = free_acceleration - push / body.inertia;
    give(now);
    evaluate();
    if (round == 0) note_decisions(is_start);
    run_.integrate(ticks);
    const double consumed =
        run_.number(plan_->integral) - before_[size_t(plan_->integral - plan_->plan.signals)];
    push = consumed / step - body.added_inertia * now[acceleration];
  }
  const double gain = free_acceleration - push / body.inertia;
  now.value[position] += step * (now[velocity] + 0.5 * step * gain), now.value[velocity] += step * gain;
  return push;
}

void EffectSample::step_against(const Body& body, double free_acceleration, Instant& instant) {
  using enum GivenSignals::Index;
  GivenSignals now;
  now.value[position] = instant.position, now.value[velocity] = instant.velocity;
  set_states(instant.states);
  instant.push = push_body(body, free_acceleration, std::min(plan_->plan.step_ticks, sample_ticks_), true,
                           now, instant.push);
  instant.position = now[position], instant.velocity = now[velocity];
  for (size_t i = 0; i < states_.size(); ++i) instant.states[i] = run_.states()[states_[i]];
}

std::vector<double> EffectSample::against(const Body& body, const std::vector<double>& states,
                                          const GivenSignals& given) {
  GivenSignals now = given;
  const double period = plan_->sizes.sample_time;
  double momentum = 0, moment = 0, push = 0;
  set_states(states);
  for (int64_t left = sample_ticks_; left > 0;) {
    const int64_t passed = std::min(plan_->plan.step_ticks, left);
    const double step = period * double(passed) / double(sample_ticks_);
    push = push_body(body, given[GivenSignals::acceleration], passed, left == sample_ticks_, now, push);
    momentum += push * step;
    // ∫ (u - ½) f du: the push of each step acts at its middle.
    moment += push * (double(sample_ticks_ - left) + 0.5 * double(passed)) / double(sample_ticks_) * step;
    left -= passed;
  }
  evaluate(), note_decisions(false);
  std::vector<double> result = this->states();
  result.push_back(momentum / period), result.push_back(12 * (moment - 0.5 * momentum) / period);
  return result;
}

std::vector<double> EffectSample::from(const std::vector<double>& states, const GivenSignals& given) {
  set_states(states), give(given);
  double integral = 0, area = 0, stated_slope = 0;
  for (int64_t left = sample_ticks_; left > 0;) {
    evaluate();
    note_decisions(left == sample_ticks_);
    if (left == sample_ticks_)
      for (const Number slope : plan_->slopes) stated_slope += run_.number(slope);
    const int64_t passed = std::min(plan_->plan.step_ticks, left);
    run_.integrate(passed), left -= passed;
    const double before = integral;
    integral = run_.number(plan_->integral);
    area += 0.5 * double(passed) / double(sample_ticks_) * (before + integral);
  }
  evaluate(), note_decisions(false);
  std::vector<double> result = this->states();
  const double period = plan_->sizes.sample_time;  // mean and slope as in EffectRun::integrate_sample
  result.push_back(integral / period);
  result.push_back(12 * (0.5 * integral - area) / period + stated_slope);
  return result;
}

SampleMap EffectSample::map() {
  SampleMap map{states_.size(), {}};
  std::vector<double> states(map.states);
  GivenSignals given;
  const auto respond_to = [&](double& one) { one = 1, map.columns.push_back(from(states, given)), one = 0; };
  std::ranges::for_each(states, respond_to), std::ranges::for_each(given.value, respond_to);
  return map;
}

bool is_linear(const std::shared_ptr<const EffectPlan>& plan) {
  const bool has_states = plan->integral >= plan->plan.signals && plan->plan.states > 1;
  if (!has_states || plan->acts_on_sensor || !remembers_only_states(*plan)) return false;
  EffectSample sample(plan);
  std::mt19937_64 random(1);
  for (double FitRange::*at : {&FitRange::start, &FitRange::low, &FitRange::high}) {
    sample.start(tried_values(*plan, at), 0, 0);
    if (!superposes(sample, random)) return false;
  }
  return true;
}

}  // namespace loopwright
