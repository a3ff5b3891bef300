#include "tools/run/figures.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "engine/diagram/figures.h"

namespace loopwright {
namespace {

constexpr double usual_band = 0.02;  ///< of the last move: the usual definition of settling

const Plan::Logged* logged(const Plan& plan, std::string_view name) {
  const auto found = std::ranges::find(plan.log, name, &Plan::Logged::name);
  return found == plan.log.end() ? nullptr : &*found;
}

const Plan::Logged* logged(const Plan& plan, Number number) {
  const auto found = std::ranges::find(plan.log, number, &Plan::Logged::number);
  return found == plan.log.end() ? nullptr : &*found;
}

double band_of(const Value& value, const Plan::Logged& signal, Problems& problems) {
  if (value.kind == Value::Kind::null) return 0;
  if (value.kind == Value::Kind::number) return value.number;
  const Value::Member *number = value.find("value"), *unit = value.find("unit");
  const auto written = unit ? parse_unit(unit->value.text) : std::optional<Unit>(signal.unit);
  if (!written || (signal.unit_is_known && !written->fits(signal.unit))) {
    auto& problem =
        problems.error(value.place, value.place.pointer(), "", "the unit of \"band\" does not fit");
    problem.expected = to_string(signal.unit), problem.found = unit->value.text;
    return 0;
  }
  return written->to_si(number->value.number);
}

std::string unit_text(const Plan::Logged& signal) {
  return signal.unit_is_known && to_string(signal.unit) != "1" ? to_string(signal.unit) : "";
}

std::vector<FollowedSignal> requested(const std::vector<FigureRequest>& requests, const Plan& plan,
                                      Problems& problems) {
  std::vector<FollowedSignal> found;
  for (const FigureRequest& request : requests) {
    const auto find = [&](const Wire& wire) {
      const Plan::Logged* signal = logged(plan, wire.source);
      if (!signal) {
        auto& problem = problems.error(wire.place, wire.place.pointer(), "",
                                       fmt::format("\"{}\" is not logged", wire.source));
        problem.hint = fmt::format("add \"{}\" to \"log\"", wire.source);
      }
      return signal;
    };
    const Plan::Logged *signal = find(request.signal), *reference = find(request.reference);
    if (!signal || !reference) continue;
    found.push_back(
        {signal->name, reference->name, unit_text(*signal), band_of(request.band, *signal, problems), false});
  }
  return found;
}

/// Integral of e² by rows, each counting half of the time to its neighbours.
double rms_over_time(const std::vector<double>& time, const std::vector<double>& error) {
  double sum = 0;
  for (size_t i = 1; i < time.size(); ++i)
    sum += 0.5 * (error[i] * error[i] + error[i - 1] * error[i - 1]) * (time[i] - time[i - 1]);
  const double duration = time.back() - time.front();
  return duration > 0 ? std::sqrt(sum / duration) : std::abs(error.back());
}

double greatest(const std::vector<double>& values, size_t begin, size_t end) {
  double most = 0;
  for (size_t i = begin; i < end; ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

/// The first row from which on the reference rests.
size_t start_of_rest(const std::vector<double>& reference) {
  const auto [low, high] = std::ranges::minmax(reference);
  const double still = 1e-9 * std::max(high - low, std::abs(high));
  size_t row = reference.size() - 1;
  while (row > 0 && std::abs(reference[row - 1] - reference.back()) <= still) --row;
  return row;
}

/// The value from which the reference's last move began: where it rested or turned before.
double start_of_move(const std::vector<double>& reference, size_t end) {
  size_t row = end;
  const double direction = reference[end] - reference[end - 1];
  while (row > 0 && (reference[row] - reference[row - 1]) * direction > 0) --row;
  return reference[row];
}

TrackingFigures::Move last_move(const FollowedSignal& followed, const std::vector<double>& time,
                                const std::vector<double>& reference, const std::vector<double>& signal,
                                size_t end) {
  TrackingFigures::Move move;
  const double from = start_of_move(reference, end), target = reference.back();
  move.end = time[end], move.size = target - from;
  move.is_jump = reference[end - 1] == from;
  move.band = followed.band > 0 ? followed.band : usual_band * std::abs(move.size);
  const double sign = move.size < 0 ? -1 : 1;
  size_t settled = time.size();
  for (size_t i = end; i < time.size(); ++i)
    move.overshoot = std::max(move.overshoot, sign * (signal[i] - target));
  while (settled > end && std::abs(signal[settled - 1] - target) <= move.band) --settled;
  if (settled < time.size()) move.settling = time[settled] - move.end;
  const size_t tail = std::max(end, time.size() - std::max<size_t>(2, (time.size() - end) / 10));
  const auto [low, high] = std::minmax_element(signal.begin() + ptrdiff_t(tail), signal.end());
  move.ripple = 0.5 * (*high - *low);
  return move;
}

}  // namespace

std::vector<FollowedSignal> followed_signals(const Diagram& diagram, const Plan& plan, Problems& problems) {
  const std::vector<FigureRequest> requests = figures_of(diagram, problems);
  return requests.empty() ? guessed_signals(plan) : requested(requests, plan, problems);
}

std::vector<FollowedSignal> guessed_signals(const Plan& plan) {
  // A controller compares "reference" with "measured", a sum with the signs "+-" two signals.
  std::vector<FollowedSignal> found;
  const auto add = [&](Number reference, Number signal) {
    const Plan::Logged *wanted = logged(plan, reference), *actual = logged(plan, signal);
    if (!wanted || !actual || wanted == actual) return;
    if (std::ranges::any_of(found, [&](const FollowedSignal& f) { return f.signal == actual->name; })) return;
    found.push_back({actual->name, wanted->name, unit_text(*actual), 0, true});
  };
  const auto signs_of = [&](const std::string& path) {
    const auto entry =
        std::ranges::find(plan.parameters, path + ".signs", &std::pair<std::string, std::string>::first);
    return entry == plan.parameters.end() ? std::string() : entry->second;
  };
  for (const Plan::Block& block : plan.blocks) {
    const auto& ports = block.type->info.inputs;
    const auto port = [&](std::string_view name) {
      const auto at = size_t(std::ranges::find(ports, name, &PortInfo::name) - ports.begin());
      return at < ports.size() && block.inputs[at].size() == 1 ? block.inputs[at].front() : Number(-1);
    };
    if (const Number wanted = port("reference"), actual = port("measured"); wanted >= 0 && actual >= 0)
      add(wanted, actual);
    if (block.type->info.type == "Sum" && block.inputs[0].size() == 2 && signs_of(block.path) == "\"+-\"")
      add(block.inputs[0][0], block.inputs[0][1]);
  }
  return found;
}

bool swings_up(const std::vector<double>& values) {
  constexpr size_t fewest = 40;   // rows
  constexpr double growth = 1.5;  // from quarter to quarter
  if (values.size() < fewest) return false;
  double before = 0;
  for (size_t quarter = 0; quarter < 4; ++quarter) {
    const size_t begin = quarter * values.size() / 4, end = (quarter + 1) * values.size() / 4;
    // The swing about the line through the ends of the quarter: a ramp has none.
    double swing = 0;
    for (size_t i = begin; i < end; ++i) {
      const double part = double(i - begin) / double(end - 1 - begin);
      swing = std::max(swing, std::abs(values[i] - values[begin] - part * (values[end - 1] - values[begin])));
    }
    if (quarter > 0 && !(swing > growth * before && swing > 0)) return false;
    before = swing;
  }
  return true;
}

std::optional<TrackingFigures> tracking_figures(const FollowedSignal& followed, const Recording& recording) {
  const Column *signal = recording.find(followed.signal), *reference = recording.find(followed.reference);
  if (!signal || !reference || recording.rows() < 2) return std::nullopt;
  const std::vector<double>& time = recording.columns.front().values;
  std::vector<double> error(time.size());
  for (size_t i = 0; i < time.size(); ++i) error[i] = reference->values[i] - signal->values[i];
  TrackingFigures figures;
  figures.followed = followed;
  figures.rms = rms_over_time(time, error);
  const auto peak = std::ranges::max_element(error, {}, [](double e) { return std::abs(e); });
  figures.greatest = std::abs(*peak), figures.at = time[size_t(peak - error.begin())];
  figures.last = error.back();
  const size_t rest = start_of_rest(reference->values);
  if (rest > 0 && rest + 1 < time.size())
    figures.move = last_move(followed, time, reference->values, signal->values, rest);
  // Growth counts where the reference does not excite the error.
  const size_t begin = figures.move ? rest : 0, rows = time.size() - begin;
  const double band = figures.move ? figures.move->band : 0;
  constexpr double growth = 1.5;
  const double thirds[] = {greatest(error, begin, begin + rows / 3),
                           greatest(error, begin + rows / 3, begin + 2 * rows / 3),
                           greatest(error, begin + 2 * rows / 3, time.size())};
  figures.grows = figures.move && rows >= 30 && thirds[2] > band && thirds[1] > growth * thirds[0] &&
                  thirds[2] > growth * thirds[1];
  figures.grows = figures.grows || swings_up(error);
  return figures;
}

}  // namespace loopwright
