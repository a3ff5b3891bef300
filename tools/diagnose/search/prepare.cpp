#include "tools/diagnose/search/prepare.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include "models/real/whole.h"
#include "models/statistics/quantile.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remembered_runs.h"
#include "tools/diagnose/search/weight.h"
#include "tools/diagnose/search/whiteness.h"
#include "tools/experiment/experiment_ports.h"

namespace loopwright::diagnosis {
namespace {

/// [rows] Half of a time, at least one.
size_t half_span(double seconds, double sample_time) {
  return std::max<size_t>(1, whole_count(std::round(seconds / 2 / sample_time)));
}

std::vector<double> speeds(const AxisRecord& record) {
  std::vector<double> speed;
  if (const MeasuredPort* velocity = record.find("velocity")) {
    for (double v : velocity->value) speed.push_back(std::abs(v));
    return speed;
  }
  const std::vector<double>& x = record.measured.front().value;
  const size_t span = half_span(criteria::speed_span_s, record.sample_time);
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
  const double normal = difference.empty() ? 0 : lower_quantile(difference, 0.5) / (0.6745 * std::sqrt(20.0));
  double scale = 0;
  for (double v : port.value) scale = std::max(scale, std::abs(v));
  return std::max({normal, port.resolution / std::sqrt(12.0), criteria::least_sensor_noise * scale, 1e-15});
}

Noise first_guess(const Trials& trials) {
  Noise noise;
  noise.white = criteria::usual_white_noise * trials.force_rms;
  noise.step = criteria::usual_slow_noise * noise.white;
  for (const MeasuredPort& port : trials.list.front().model->record().measured)
    noise.measurement.push_back(trials.has_map() ? noise.white : measurement_noise(port));
  return noise;
}

/// The waits that a record affords if it has many rows.
Pace pace_of(AxisModel& model, const Noise& noise, double rest_speed) {
  const LinearAxis axis = model.linearize();
  const double constant = correction_time(axis, gains_of(axis, noise, model.nominal_inertia()));
  const double sample_time = model.record().sample_time, memory = criteria::slow_memory_s / sample_time;
  const auto rows = [](double wait) {
    return int(std::max<size_t>(criteria::least_correction, whole_count(std::ceil(wait))));
  };
  return {rest_speed,
          rows(std::max(criteria::correction * constant, criteria::correction_s / sample_time - 1e-9)),
          rows(std::max(criteria::after_rest * memory, criteria::correction_after_rest * constant))};
}

/// Shorter waits; false if they are as short as they may be.
bool shorten(Pace& pace) {
  const auto shorter = [](int rows) {
    return std::max(criteria::least_correction, int(criteria::shorter_wait * rows));
  };
  const Pace before = pace;
  pace.samples_to_correct = shorter(pace.samples_to_correct);
  pace.samples_after_rest = shorter(pace.samples_after_rest);
  return pace.samples_to_correct < before.samples_to_correct ||
         pace.samples_after_rest < before.samples_after_rest;
}

/// [rows] On either side of a row, within which a motion slower than this speed shows as a rest; 0: the
/// counts are too coarse to show it in time.
size_t reach_of_a_rest(const AxisRecord& record, double rest_speed) {
  const MeasuredPort* position = record.find("position");
  if (!position || record.is_map || !(rest_speed > 0)) return 0;
  const double of_counts = criteria::counts_of_a_rest * position->resolution / (2 * rest_speed);
  if (of_counts > criteria::glance_s) return 0;
  return std::max<size_t>(
      2, whole_count(std::round(std::max(criteria::deviation_s, of_counts) / record.sample_time)));
}

/// Whether the measured position stays where it is about a row: it moves less than at the speed that counts
/// as rest.
bool stays(const AxisRecord& record, size_t row, double rest_speed, size_t reach) {
  if (reach == 0 || row < reach || row + reach >= record.rows()) return false;
  const double* at = record.find("position")->value.data() + row;
  const auto [low, high] = std::minmax_element(at - reach, at + reach + 1);
  return *high - *low <= rest_speed * double(2 * reach) * record.sample_time;
}

/// Rows while moving, some time after the last rest or reversal; and rows at rest.
void mark_usable(Trial& trial, const Path& path, bool is_map) {
  const AxisRecord& record = trial.model->record();
  const size_t rows = path.samples();
  trial.moving.assign(rows, 1), trial.at_rest.assign(rows, 0);
  int since_rest = trial.pace.samples_after_rest;
  const double rest_speed = trial.pace.rest_speed;
  const size_t reach = reach_of_a_rest(record, rest_speed);
  trial.settled_from = is_map ? 1
                              : std::max(whole_count(std::ceil(criteria::settling_s / path.sample_time)),
                                         size_t(trial.pace.samples_to_correct));
  for (size_t k = 0; k < rows; ++k) {
    // The velocity of an axis that rests is guessed rightly. Where a force is missing, or friction holds it
    // with nearly all that it has, the predictor drifts.
    const bool rests = path.rests[k] || stays(record, k, rest_speed, reach);
    since_rest = rests ? 0 : since_rest + 1;
    trial.moving[k] = since_rest > trial.pace.samples_after_rest && !path.turns[k] &&
                      k >= trial.settled_from && !record.is_false(k);
    trial.at_rest[k] = rests && k >= size_t(trial.pace.samples_to_correct) && !record.is_false(k);
  }
  trial.usable = trial.moving;
}

/// The rows that count along the nominal diagram's prediction. Where reversals follow each other so fast that
/// the waits leave too few, these become shorter.
std::vector<Fitted> mark_usable(Trials& trials) {
  for (;;) {
    std::vector<Fitted> nominal = run_members(trials, {}, {}, trials.noise);
    for (size_t t = 0; t < trials.list.size(); ++t)
      mark_usable(trials.list[t], nominal[t].prediction.path, trials.has_map());
    bool is_shorter = false;
    if (!trials.has_map() && judged_numbers(trials) < criteria::plenty_of_rows * double(trials.ports()))
      for (Trial& trial : trials.list) is_shorter |= shorten(trial.pace);
    if (!is_shorter) return nominal;
  }
}

/// Where motor and load are two bodies in the diagram, and the roles those of the load, the noise of the
/// input moves the motor. The likelihood decides.
void look_where_noise_enters(Trials& trials, std::vector<Fitted>& nominal) {
  bool differs = false;
  for (Trial& trial : trials.list) differs |= trial.model->set_noise_enters_at_input(true);
  if (differs) {
    std::vector<Fitted> other = run_members(trials, {}, {}, trials.noise);
    const Noise noise = fit_noise(trials, other, trials.noise, FreeNoise::with_random_walk);
    other = run_members(trials, {}, {}, noise);
    // What is missing blurs the difference: without a clear one it is the noise of an actuator.
    constexpr double unclear = 0.01;  // [-2 ln L a row]
    if (profile(trials, other) < profile(trials, nominal) + unclear * double(fitted_numbers(trials))) {
      trials.noise = noise, nominal = std::move(other);
      return;
    }
  }
  for (Trial& trial : trials.list) trial.model->set_noise_enters_at_input(false);
}

void reject_without_fitted_rows(const Trials& trials) {
  if (std::ranges::any_of(trials.list, [](const Trial& trial) { return trial.held_out_from > 0; })) return;
  Problems problems;
  problems.error({}, "/hold_out", "", "every record is held out as a whole").expected = "a record to fit";
  throw InputError(std::move(problems));
}

/// A weight that the input holds drives nothing.
double mean_force(const Trials& trials) {
  double sum = 0;
  size_t n = 0;
  for (const Trial& trial : trials.list)
    for (double f : trial.model->driving_force()) sum += f, ++n;
  return sum / double(std::max<size_t>(n, 1));
}

double force_rms(const Trials& trials, double held) {
  double square = 0;
  size_t n = 0;
  for (const Trial& trial : trials.list)
    for (double f : trial.model->driving_force()) square += (f - held) * (f - held), ++n;
  return std::sqrt(square / double(std::max<size_t>(n, 1)));
}

/// Kicks of a controller that is given a step are a large part of the rms, and no part of the motion.
double usual_force(const Trials& trials, double held) {
  std::vector<double> sizes;
  for (const Trial& trial : trials.list) {
    const std::vector<double>& force = trial.model->driving_force();
    for (size_t k = 0; k < force.size(); ++k)
      if (trial.moving[k]) sizes.push_back(std::abs(force[k] - held));
  }
  return sizes.empty() ? trials.force_rms
                       : std::min(trials.force_rms, lower_quantile(sizes, criteria::usual_share));
}

std::string names_of_ports(const AxisRecord& record) {
  std::string names;
  for (const MeasuredPort& port : record.measured) names += (names.empty() ? "" : " and ") + port.role;
  return names;
}

/// The noise of a motion and that of a map are not related, and every sensor has one noise in all records.
void reject_mixed(const Trials& trials) {
  Problems problems;
  const AxisRecord& first = trials.list.front().model->record();
  for (const Trial& trial : trials.list) {
    const AxisRecord& record = trial.model->record();
    if (record.is_map != trials.has_map()) {
      auto& p = problems.error(record.place, "/rows", "", "maps of balances and records of motion are mixed");
      p.expected = "one kind at a time";
    } else if (names_of_ports(record) != names_of_ports(first)) {
      auto& p =
          problems.error(record.place, "/compare", "", "the records do not measure the same of the axis");
      p.expected = names_of_ports(first) + ", as in " + first.path;
      p.found = names_of_ports(record);
      if (!record.left_out.empty() || !first.left_out.empty())
        p.hint =
            "a sensor that is read less often than the other one is left out: leave it out of \"compare\" in "
            "all";
    }
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
}

/// A sample has one noise in all records. If rows of a long one are put together, so are those of the others.
/// `read` reads a record again with so many rows in one.
void take_one_rate(Trials& trials, const std::function<std::unique_ptr<AxisModel>(size_t, size_t)>& read) {
  constexpr double same_rate = 0.02;  // noise of a sample differs by half of it
  size_t most = 1;
  for (const Trial& trial : trials.list) most = std::max(most, trial.model->record().rows_in_one);
  Problems problems;
  for (size_t t = 0; t < trials.list.size() && !trials.has_map(); ++t) {
    Trial& trial = trials.list[t];
    if (trial.model->record().rows_in_one != most) trial.model = read(t, most);
    const AxisRecord &first = trials.list.front().model->record(), &record = trial.model->record();
    if (std::abs(record.sample_time - first.sample_time) <= same_rate * first.sample_time) continue;
    auto& p = problems.error(record.place, "/data", "", "the records have different rates");
    p.expected = fmt::format("{:.6g} s from row to row, as in {}", first.sample_time, first.path);
    p.found = fmt::format("{:.6g} s", record.sample_time);
    p.hint = "diagnose them one by one: noise of a sample is another one at another rate";
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
}

}  // namespace

Trials prepare(const std::string& diagram, const std::vector<std::string>& experiments,
               const LoadOptions& options, Motion& motion, const InputCorrection& correction) {
  Trials trials;
  trials.remembered = std::make_shared<RememberedRuns>();
  std::vector<double> speed;
  const auto read = [&](size_t number, size_t rows_in_one) {
    try {
      return std::make_unique<AxisModel>(diagram, experiments[number], options, correction, rows_in_one);
    } catch (InputError& error) {
      explain_failure(diagram, experiments, options, std::move(error.problems));
    }
  };
  for (size_t i = 0; i < experiments.size(); ++i) trials.list.emplace_back().model = read(i, 0);
  reject_mixed(trials);
  take_one_rate(trials, read);
  for (Trial& trial : trials.list) {
    const AxisRecord& record = trial.model->record();
    trial.held_out_from = record.held_out_from;
    const std::vector<double> own = speeds(record);
    speed.insert(speed.end(), own.begin(), own.end());
  }
  reject_without_fitted_rows(trials);
  trials.run_along(Trials::Rows::all);
  if (const MeasuredPort* position = trials.list.front().model->record().find("position"))
    if (position->unit == "rad") trials.turn = 2 * std::numbers::pi;
  const double held = mean_force(trials);
  trials.force_rms = std::max(force_rms(trials, held), criteria::least_change * std::abs(held));
  trials.noise = first_guess(trials);
  const double rest_speed = speed.empty() ? 0 : criteria::rest_speed * lower_quantile(speed, 0.99);
  for (Trial& trial : trials.list) trial.pace = pace_of(*trial.model, trials.noise, rest_speed);
  trials.nominal_holds = std::ranges::any_of(
      trials.list, [&](Trial& trial) { return trial.model->holds_at_rest(1e-3 * trials.force_rms); });
  std::vector<Fitted> nominal = mark_usable(trials);
  trials.usual_force = usual_force(trials, held);
  trials.noise = fit_noise(trials, nominal, trials.noise, FreeNoise::with_random_walk);
  nominal = run_members(trials, {}, {}, trials.noise);
  look_where_noise_enters(trials, nominal);
  const bool is_loud = trials.noise.white > criteria::loud_noise * trials.force_rms;
  trials.noise_is_seen =
      is_loud && !trials.has_map() && portmanteau(trials, nominal) < criteria::most_portmanteau_of_noise_seen;
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
