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

/// Differences up to this are rounding.
double still(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return 1e-9 * std::max(high - low, std::abs(high));
}

/// The first row from which on the reference rests.
size_t start_of_rest(const std::vector<double>& reference) {
  const double rounding = still(reference);
  size_t row = reference.size() - 1;
  while (row > 0 && std::abs(reference[row - 1] - reference.back()) <= rounding) --row;
  return row;
}

/// The value from which the reference's last move began: where it rested or turned before.
double start_of_move(const std::vector<double>& reference, size_t end) {
  size_t row = end;
  const double direction = reference[end] - reference[end - 1];
  while (row > 0 && (reference[row] - reference[row - 1]) * direction > 0) --row;
  return reference[row];
}

using Move = TrackingFigures::Move;

/// Kind and size of the move that ends in the row `end`; nothing: there is none.
std::optional<Move> move_before(size_t end, const FollowedSignal& followed,
                                const std::vector<double>& reference, const std::vector<double>& signal) {
  Move move;
  const double target = reference.back();
  if (end > 0) {
    const double from = start_of_move(reference, end);
    move.kind = reference[end - 1] == from ? Move::Kind::jump : Move::Kind::stop;
    move.size = target - from;
    return move;
  }
  // A signal that begins much closer to the target than it is later has not moved there: it was disturbed.
  const auto distance = [&](double value) { return std::abs(value - target); };
  const double most = distance(std::ranges::max(signal, {}, distance)), size = target - signal.front();
  if (std::abs(size) > std::max({usual_band * most, still(reference), still(signal)})) {
    move.kind = Move::Kind::start, move.size = size;
    return move;
  }
  move.kind = Move::Kind::stay;
  return followed.band > 0 ? std::optional(move) : std::nullopt;
}

/// s after the row `end`. A signal that passes through the band when the run ends has not settled.
std::optional<double> settling_time(const Move& move, size_t end, const std::vector<double>& time,
                                    const std::vector<double>& signal, double target) {
  constexpr double least_stay = 0.1;  // of the time after the move
  size_t row = time.size();
  while (row > end && std::abs(signal[row - 1] - target) <= move.band) --row;
  if (row + 2 > time.size() || time.back() - time[row] < least_stay * (time.back() - time[end])) return {};
  return time[row] - time[end];
}

std::optional<Move> last_move(const FollowedSignal& followed, const std::vector<double>& time,
                              const std::vector<double>& reference, const std::vector<double>& signal,
                              size_t end) {
  std::optional<Move> found = move_before(end, followed, reference, signal);
  if (!found) return found;
  Move& move = *found;
  const double target = reference.back(), sign = move.size < 0 ? -1 : 1;
  move.end = time[end];
  move.band = followed.band > 0 ? followed.band : usual_band * std::abs(move.size);
  for (size_t i = end; i < time.size() && move.size != 0; ++i)
    move.overshoot = std::max(move.overshoot, sign * (signal[i] - target));
  move.settling = settling_time(move, end, time, signal, target);
  const size_t tail = std::max(end, time.size() - std::max<size_t>(2, (time.size() - end) / 10));
  const auto [low, high] = std::minmax_element(signal.begin() + ptrdiff_t(tail), signal.end());
  move.ripple = 0.5 * (*high - *low);
  return found;
}

/// Whether |e| grows by this factor from part to part of the rows from `begin` on.
bool grows_by_parts(const std::vector<double>& error, size_t begin, size_t parts, double growth) {
  const size_t rows = error.size() - begin;
  if (rows < 10 * parts) return false;
  double before = 0;
  for (size_t part = 0; part < parts; ++part) {
    const double now = greatest(error, begin + part * rows / parts, begin + (part + 1) * rows / parts);
    if (part > 0 && !(now > growth * before)) return false;
    before = now;
  }
  return true;
}

/// Growth counts where the reference does not excite the error.
bool grows_at_rest(const TrackingFigures& figures, const std::vector<double>& error, size_t rest) {
  const auto& move = figures.move;
  if (move && move->kind != Move::Kind::stay)
    return greatest(error, rest + 2 * (error.size() - rest) / 3, error.size()) > move->band &&
           grows_by_parts(error, rest, 3, 1.5);
  // Without a move only a disturbance excites the error. One that rises, or comes in steps, makes it grow,
  // but not by so much from twelfth to twelfth throughout.
  return figures.is_constant && grows_by_parts(error, 0, 12, 1.25);
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
  figures.is_constant = rest == 0;
  if (rest + 1 < time.size())
    figures.move = last_move(followed, time, reference->values, signal->values, rest);
  figures.grows = grows_at_rest(figures, error, rest) || swings_up(error);
  return figures;
}

}  // namespace loopwright
