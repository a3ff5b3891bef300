#include "tools/effects/held_effect.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace loopwright {
namespace {

/// Rows of a random signal by which superposition is tried, besides those that are remembered, and those in
/// turn that have one magnitude, from 10^-6 to 10^3: a threshold or a square shows at one of them.
constexpr size_t tried_rows = 256, rows_of_a_magnitude = 16;
/// Of the sum of the magnitudes of all terms; rounding leaves less than 1e-12.
constexpr double tolerance = 1e-9;
/// Numbers that are remembered; more would cost more than they save.
constexpr int most_numbers = 10000;
/// Of a fit, before and after a step and with each parameter changed.
constexpr size_t most_known = 8;

bool reads_one_held_signal(const Plan& plan) {
  std::vector<std::string> signals;
  for (const Plan::Block& block : plan.blocks)
    if (block.type->info.type == "ExternalSignal") signals.push_back(block.path);
  return signals.size() == 1 && (signals[0] == "given_input" || signals[0] == "given_force");
}

/// What is remembered is samples of the signal, of which one is taken at each row, and nothing is decided.
bool takes_a_sample_a_row(const EffectPlan& effect) {
  const Plan& plan = effect.plan;
  const auto sample = int64_t(std::llround(effect.sizes.sample_time / plan.clock.time(1)));
  const bool once_a_row = std::ranges::all_of(plan.rates, [&](const Rate& rate) {
    return rate.kind != Rate::Kind::sampled || (rate.period == sample && rate.offset == 0);
  });
  return once_a_row && plan.states == 1 && plan.buffer_numbers > 0 && plan.buffer_numbers <= most_numbers &&
         std::ranges::all_of(plan.blocks, [](const Plan::Block& block) {
           const BlockInfo& info = block.type->info;
           const bool switches = !info.crossings.empty() && info.type != "Integrator";
           return info.type == "ExternalSignal" ||
                  (!info.uses_time && info.memory_numbers.empty() && !switches);
         });
}

}  // namespace

double HeldResponse::mean(std::span<const double> signal, size_t row) const {
  double sum = 0;
  for (const Row& r : rows)
    if (r.after <= row) sum += r.mean * signal[row - r.after];
  return sum;
}

double HeldResponse::slope(std::span<const double> signal, size_t row) const {
  double sum = 0;
  for (const Row& r : rows)
    if (r.after <= row) sum += r.slope * signal[row - r.after];
  return sum;
}

HeldEffect::HeldEffect(std::shared_ptr<const EffectPlan> plan)
    : plan_(std::move(plan)), lanes_(*plan_, InstructionSet::scalar, 1) {}

std::span<const double> HeldEffect::signal(const RoleSignals& signals) const {
  return lanes_.input.is_read() ? signals.input : signals.force;
}

/// What is held within a sample has the value of its start as its mean.
std::vector<HeldEffect::Value> HeldEffect::run(const std::vector<double>& fitted,
                                               const std::vector<double>& signal) {
  std::vector<Value> values;
  lanes_.start({fitted}, {});
  for (const double number : signal) {
    GivenSignals given;
    given.value[lanes_.input.is_read() ? GivenSignals::input : GivenSignals::force] = number;
    const double now = lanes_.run().time();
    lanes_.give(given, now);
    lanes_.read_first(now);
    values.push_back({lanes_.value[0], lanes_.stated_slope[0]});
    for (int64_t left = lanes_.sample_ticks(); left > 0;) left -= lanes_.run().integrate(left);
  }
  return values;
}

std::shared_ptr<const HeldResponse> HeldEffect::response(const std::vector<double>& fitted) {
  for (const auto& [of, response] : known_)
    if (of == fitted) return response;
  std::vector<double> one(remembered_rows());
  one[0] = 1;
  const std::vector<Value> values = run(fitted, one);
  auto response = std::make_shared<HeldResponse>();
  for (size_t k = 0; k < values.size(); ++k)
    if (values[k].mean != 0 || values[k].slope != 0)
      response->rows.push_back({k, values[k].mean, values[k].slope});
  known_.emplace_back(fitted, response);
  if (known_.size() > most_known) known_.pop_front();
  return response;
}

bool HeldEffect::superposes(const std::vector<double>& fitted) {
  const HeldResponse known = *response(fitted);
  HeldResponse sizes = known;
  for (HeldResponse::Row& row : sizes.rows) row.mean = std::abs(row.mean), row.slope = std::abs(row.slope);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> magnitude(-6, 3), share(-1, 1);
  std::vector<double> signal, size_of;
  for (size_t k = 0; k < remembered_rows() + tried_rows; ++k) {
    const double size = k % rows_of_a_magnitude == 0 ? std::pow(10, magnitude(random)) : size_of.back();
    size_of.push_back(size), signal.push_back(size * share(random));
  }
  const std::vector<Value> values = run(fitted, signal);
  for (size_t k = 0; k < signal.size(); ++k)
    if (!(std::abs(values[k].mean - known.mean(signal, k)) <= tolerance * sizes.mean(size_of, k)) ||
        !(std::abs(values[k].slope - known.slope(signal, k)) <= tolerance * sizes.slope(size_of, k)))
      return false;
  return true;
}

bool is_held(const std::shared_ptr<const EffectPlan>& plan) {
  if (plan->acts_on_sensor || !reads_one_held_signal(plan->plan) || !takes_a_sample_a_row(*plan))
    return false;
  HeldEffect effect(plan);
  return std::ranges::all_of(std::array{&FitRange::start, &FitRange::low, &FitRange::high},
                             [&](auto at) { return effect.superposes(tried_values(*plan, at)); });
}

}  // namespace loopwright
