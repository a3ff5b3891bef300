#include "tools/diagnose/search/prepare.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include "tools/experiment/experiment_ports.h"

namespace loopwright::diagnosis {
namespace {

constexpr double settling_s = 0.1;  // rows after the start that do not count
constexpr int memory_of_rest = 50;  // rows after a rest that do not count: the slow force decays in 30

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + std::ptrdiff_t(whole_index(fraction * double(values.size() - 1), values.size()));
  std::ranges::nth_element(values, at);
  return *at;
}

std::vector<double> speeds(const AxisRecord& record) {
  std::vector<double> speed;
  if (const MeasuredPort* velocity = record.find("velocity")) {
    for (double v : velocity->value) speed.push_back(std::abs(v));
    return speed;
  }
  const std::vector<double>& x = record.measured.front().value;
  const size_t span = 5;
  for (size_t k = span; k + span < x.size(); ++k)
    speed.push_back(std::abs(x[k + span] - x[k - span]) / (2 * double(span) * record.sample_time));
  return speed;
}

/// White noise of a measured port: third differences remove most of the motion.
double measurement_noise(const MeasuredPort& port) {
  std::vector<double> difference;
  for (size_t k = 3; k < port.value.size(); ++k)
    difference.push_back(
        std::abs(port.value[k] - 3 * port.value[k - 1] + 3 * port.value[k - 2] - port.value[k - 3]));
  const double normal = quantile(difference, 0.5) / (0.6745 * std::sqrt(20.0));
  double scale = 0;
  for (double v : port.value) scale = std::max(scale, std::abs(v));
  return std::max({normal, port.resolution / std::sqrt(12.0), 1e-9 * scale, 1e-15});
}

Noise first_guess(const Trials& trials) {
  Noise noise;
  noise.white = 0.01 * trials.force_rms;
  noise.step = 0.3 * noise.white;
  for (const MeasuredPort& port : trials.list.front().model->record().measured)
    noise.measurement.push_back(trials.has_map() ? noise.white : measurement_noise(port));
  return noise;
}

/// Rows while moving, some time after the last rest or reversal; and rows at rest.
void mark_usable(Trial& trial, const Path& path, bool is_map) {
  const size_t rows = path.samples();
  trial.moving.assign(rows, 1), trial.at_rest.assign(rows, 0);
  int since_rest = memory_of_rest;
  const int start = is_map ? 1 : int(whole_count(std::ceil(settling_s / path.sample_time)));
  for (size_t k = 0; k < rows; ++k) {
    since_rest = path.rests[k] ? 0 : since_rest + 1;
    trial.moving[k] = since_rest > memory_of_rest && !path.turns[k] && int(k) >= start;
    trial.at_rest[k] = path.rests[k] && int(k) >= start;
  }
  trial.usable = trial.moving;
}

/// The noise of a motion and that of a map are not related.
void reject_mixed(const Trials& trials) {
  Problems problems;
  for (const Trial& trial : trials.list) {
    const AxisRecord& record = trial.model->record();
    if (record.is_map == trials.has_map()) continue;
    auto& p = problems.error(record.place, "/rows", "", "maps of balances and records of motion are mixed");
    p.expected = "one kind at a time";
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
}

}  // namespace

Trials prepare(const std::string& diagram, const std::vector<std::string>& experiments,
               const LoadOptions& options, Motion& motion) {
  Trials trials;
  std::vector<double> speed;
  double square = 0;
  size_t n = 0;
  for (const std::string& experiment : experiments) {
    Trial trial;
    try {
      trial.model = std::make_unique<AxisModel>(diagram, experiment, options);
    } catch (InputError& error) {
      explain_failure(diagram, experiments, options, std::move(error.problems));
    }
    const AxisRecord& record = trial.model->record();
    trial.held_out_from = record.held_out_from;
    const std::vector<double> own = speeds(record);
    speed.insert(speed.end(), own.begin(), own.end());
    for (double f : trial.model->driving_force()) square += f * f, ++n;
    trials.list.push_back(std::move(trial));
  }
  reject_mixed(trials);
  trials.run_along(Trials::Rows::all);
  trials.rest_speed = 0.005 * quantile(speed, 0.99);
  trials.force_rms = std::sqrt(square / double(std::max<size_t>(n, 1)));
  trials.noise = first_guess(trials);
  trials.nominal_holds = trials.list.front().model->holds_at_rest(1e-3 * trials.force_rms);
  std::vector<Fitted> nominal = run_members(trials, {}, {}, trials.noise);
  for (size_t t = 0; t < trials.list.size(); ++t)
    mark_usable(trials.list[t], nominal[t].prediction.path, trials.has_map());
  trials.noise = fit_noise(trials, nominal, trials.noise, FreeNoise::with_random_walk);
  nominal = run_members(trials, {}, {}, trials.noise);
  trials.lowest_position = 1e300, trials.highest_position = -1e300;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Path& path = nominal[t].prediction.path;
    const auto [low, high] = std::ranges::minmax(path.predicted_position);
    trials.lowest_position = std::min(trials.lowest_position, low);
    trials.highest_position = std::max(trials.highest_position, high);
    trials.longest_s = std::max(trials.longest_s, double(path.samples()) * path.sample_time);
    mark_usable(trials.list[t], path, trials.has_map());
    motion.paths.push_back(std::make_shared<const Path>(std::move(nominal[t].prediction.path)));
  }
  return trials;
}

}  // namespace loopwright::diagnosis
