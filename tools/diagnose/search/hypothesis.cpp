#include "tools/diagnose/search/hypothesis.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include "tools/diagnose/predict/flying_load.h"
#include "tools/diagnose/predict/in_parallel.h"
#include "tools/diagnose/predict/linear_load.h"
#include "tools/diagnose/search/input_chain.h"

namespace loopwright::diagnosis {
namespace {

/// A step in a nonlinear parameter for its derivative, within its range.
double difference_step(const CandidateParameter& range, double at) {
  if (range.span > 0) return 0.003 * at * at / range.span;
  const double step =
      range.step > 0 ? range.step : 1e-3 * (range.logarithmic ? std::abs(at) : range.high - range.low);
  return at + step > range.high ? -step : step;
}

std::vector<float> divided(const std::vector<double>& change, double step) {
  std::vector<float> result(change.size());
  for (size_t k = 0; k < result.size(); ++k) result[k] = float(change[k] / step);
  return result;
}

/// d(consumed)/d(parameter) of a member that does not change the input: its columns, then a difference for
/// each shape.
Columns derivatives(const Member& member, const Path& path) {
  std::vector<std::vector<double>> shapes{member.nonlinear};
  std::vector<double> steps;
  for (size_t i = 0; i < member.nonlinear.size(); ++i) {
    if (!member.is_free(i)) continue;
    shapes.push_back(member.nonlinear);
    steps.push_back(difference_step(member.candidate->nonlinear[i], member.nonlinear[i]));
    shapes.back()[i] += steps.back();
  }
  std::vector<Columns> at = member.candidate->columns_at(path, shapes);
  Columns result = member.candidate->amplitude_is_one ? Columns{} : at[0];
  for (size_t i = 0; i < steps.size(); ++i) {
    std::vector<double> change(path.samples()), slope;
    std::vector<Member> stepped{member};
    set_value(stepped, {0, false, i}, shapes[i + 1][i]);
    add_columns(stepped.front(), at[i + 1], change, slope);
    add_columns(member, at[0], change, slope, -1);
    result.emplace_back(divided(change, steps[i]), divided(slope, steps[i]));
  }
  return result;
}

/// The load of a member against the axis as it is at given parameters.
std::unique_ptr<SwitchedSample> load_of(const Member& member, const Member& given, const LinearAxis& axis) {
  auto load = member.candidate->switched_load(member);
  load->set_body({axis.inertia, given.candidate->added_inertia(given)});
  return load;
}

/// The same for the load that is a state of the predictor.
Columns flying_derivatives(const Member& member, const Fitted& fitted) {
  std::vector<std::unique_ptr<SwitchedSample>> changed;
  std::vector<double> steps;
  std::vector<Member> stepped{member};
  for (const FreeParameter& parameter : free_parameters({member})) {
    const CandidateParameter& range = range_of(stepped, parameter);
    const double at = value_of(stepped, parameter);
    steps.push_back(parameter.is_linear ? 1e-3 * std::max(std::abs(at), std::abs(range.start))
                                        : difference_step(range, at));
    set_value(stepped, parameter, at + steps.back());
    changed.push_back(load_of(stepped.front(), member, fitted.axis));
    stepped.front() = member;
  }
  const auto load = load_of(member, member, fitted.axis);
  return load_derivatives(*load, changed, steps, fitted.prediction.path, *fitted.flight);
}

/// The same for a member that changes the input, as consumed input at the end of the chain.
Column input_derivative(std::vector<Member> members, const FreeParameter& parameter, InputChain& chain) {
  const CandidateParameter& range = range_of(members, parameter);
  const double at = value_of(members, parameter),
               step = parameter.is_linear ? 1e-3 : difference_step(range, at);
  const double before = parameter.is_linear ? at - step : std::clamp(at - step, range.low, range.high);
  set_value(members, parameter, at + step);
  ChangedInput change = chain.through(members);
  set_value(members, parameter, before);
  const ChangedInput low = chain.through(members);
  change.slope.resize(std::max(change.slope.size(), low.slope.size()), 0.0);
  for (size_t k = 0; k < change.mean.size(); ++k) change.mean[k] -= low.mean[k];
  for (size_t k = 0; k < low.slope.size(); ++k) change.slope[k] -= low.slope[k];
  return Column(divided(change.mean, before - at - step), divided(change.slope, before - at - step));
}

template <class F>
void for_counted_rows(const Trials& trials, const std::vector<Fitted>& fitted, bool held_out, F&& f) {
  const size_t ports = trials.ports();
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const size_t from = held_out ? trial.held_out_from : 0;
    const size_t to = held_out ? trial.usable.size() : trial.held_out_from;
    for (size_t k = from; k < to; ++k)
      if (trial.usable[k]) f(fitted[t], k, std::span(fitted[t].white).subspan(k * ports, ports));
  }
}

/// The first member with a load that the predictor can follow through its flights.
const Member* flying_member(const std::vector<Member>& members, const AxisModel& model,
                            const LinearAxis& axis) {
  const AxisRecord& record = model.record();
  if (record.is_map || !record.duration.empty() || axis.position < 0 || axis.velocity < 0) return nullptr;
  const auto flies = std::ranges::find_if(
      members, [](const Member& m) { return m.candidate->switched_load && m.candidate->added_inertia; });
  return flies == members.end() ? nullptr : &*flies;
}

/// of_input() beside of_member(m) of all others. Members of one candidate share the runs of its blocks, and
/// come one after the other.
template <class Input, class Each>
void beside_each_other(const std::vector<Member>& members, Input&& of_input, Each&& of_member) {
  std::vector<std::vector<size_t>> groups;
  for (size_t m = 0; m < members.size(); ++m) {
    if (members[m].candidate->acts == Acts::input) continue;
    const auto same = std::ranges::find_if(groups, [&](const std::vector<size_t>& group) {
      return members[group.front()].candidate == members[m].candidate;
    });
    if (same == groups.end())
      groups.push_back({m});
    else
      same->push_back(m);
  }
  const bool changes_input =
      std::ranges::any_of(members, [](const Member& m) { return m.candidate->acts == Acts::input; });
  if (!changes_input) of_input();
  in_parallel(groups.size() + changes_input, [&](size_t i) {
    if (i == groups.size()) return of_input();
    for (const size_t m : groups[i]) of_member(m);
  });
}

std::vector<double> slope_of(const AxisRecord& record, size_t rows) {
  std::vector<double> slope = record.input_slope;
  if (!slope.empty()) slope.resize(rows);
  return slope;
}

}  // namespace

void Trials::run_along(Rows rows) {
  for (Trial& trial : list) {
    const std::vector<double>& whole = trial.model->record().input;
    const size_t end = rows == Rows::all ? whole.size() : trial.held_out_from;
    trial.input.assign(whole.begin(), whole.begin() + std::ptrdiff_t(end));
  }
}

Motion cut(const Motion& motion, const Trials& trials) {
  Motion shorter{{}, motion.profile};
  for (size_t t = 0; t < trials.list.size(); ++t)
    shorter.paths.push_back(
        std::make_shared<const Path>(motion.paths[t]->first_samples(trials.list[t].rows())));
  return shorter;
}

std::vector<FreeParameter> free_parameters(const std::vector<Member>& members) {
  std::vector<FreeParameter> free;
  for (size_t m = 0; m < members.size(); ++m) {
    if (!members[m].candidate->amplitude_is_one)
      for (size_t i = 0; i < members[m].linear.size(); ++i) free.push_back({m, true, i});
    for (size_t i = 0; i < members[m].nonlinear.size(); ++i)
      if (members[m].is_free(i)) free.push_back({m, false, i});
  }
  return free;
}

double& value_of(std::vector<Member>& members, const FreeParameter& p) {
  Member& member = members[p.member];
  return p.is_linear ? member.linear[p.index] : member.nonlinear[p.index];
}

const CandidateParameter& range_of(const std::vector<Member>& members, const FreeParameter& p) {
  const Candidate& candidate = *members[p.member].candidate;
  return p.is_linear ? candidate.linear[p.index] : candidate.nonlinear[p.index];
}

bool is_period(const Member& member, const FreeParameter& p) {
  return member.candidate->is_periodic && member.linear.size() == 2 && !p.is_linear && p.index == 0;
}

void set_value(std::vector<Member>& members, const FreeParameter& p, double value) {
  Member& member = members[p.member];
  if (is_period(member, p)) {
    const double centre = member.candidate->nonlinear[0].centre;
    const double ahead = 2 * std::numbers::pi * centre * (1 / value - 1 / member.nonlinear[0]);
    const double sine = member.linear[0], cosine = member.linear[1];
    member.linear = {sine * std::cos(ahead) + cosine * std::sin(ahead),
                     cosine * std::cos(ahead) - sine * std::sin(ahead)};
  }
  value_of(members, p) = value;
}

double added_inertia(const std::vector<Member>& members) {
  double added = 0;
  for (const Member& member : members)
    if (member.candidate->added_inertia) added += member.candidate->added_inertia(member);
  return added;
}

Drives drives_of(const std::vector<Member>& members, const Path& path, const std::vector<double>& raw_input,
                 const Member* without) {
  Drives drives;
  drives.along = &path;
  ChangedInput changed;
  std::vector<Columns> columns(members.size());
  beside_each_other(
      members, [&] { changed = InputChain(path, raw_input).through(members); },
      [&](size_t m) {
        if (&members[m] != without) columns[m] = members[m].candidate->columns(path, members[m].nonlinear);
      });
  drives.input = std::move(changed.mean), drives.input_slope = std::move(changed.slope);
  drives.force.assign(raw_input.size(), 0.0);
  double inertia = added_inertia(members);
  if (without) inertia -= without->candidate->added_inertia(*without);
  if (inertia != 0)
    for (size_t k = 0; k < drives.force.size(); ++k) drives.force[k] = -inertia * path.acceleration[k];
  for (size_t m = 0; m < members.size(); ++m) {
    const Acts acts = members[m].candidate->acts;
    if (&members[m] == without) continue;
    if (acts == Acts::force) add_columns(members[m], columns[m], drives.force, drives.force_slope);
    if (acts != Acts::sensor) continue;
    std::vector<double> no_slope;
    drives.sensor.resize(raw_input.size(), 0.0);
    add_columns(members[m], columns[m], drives.sensor, no_slope);
  }
  return drives;
}

std::vector<Fitted> run_members(Trials& trials, const std::vector<Member>& members, const Motion& motion,
                                const Noise& noise) {
  if (trials.interrupt && *trials.interrupt) throw Interrupted{};
  std::vector<Fitted> result;
  const double inertia = added_inertia(members);
  for (size_t t = 0; t < trials.list.size(); ++t) {
    AxisModel& model = *trials.list[t].model;
    Fitted fitted;
    model.set_added_inertia(inertia);
    fitted.axis = model.linearize();
    if (!model.record().is_map)
      for (const Member& member : members)
        if (member.candidate->linear_load)
          fitted.axis = with_load(std::move(fitted.axis), member.candidate->linear_load(member));
    const std::vector<double>& raw = trials.list[t].input;
    const Pace& pace = trials.list[t].pace;
    const bool may_follow = trials.follows_flights && !motion.paths.empty();
    if (const Member* flies = may_follow ? flying_member(members, model, fitted.axis) : nullptr) {
      FlyingLoad load(load_of(*flies, *flies, fitted.axis), fitted.axis, noise, model.nominal_inertia());
      fitted.prediction =
          predict(model, fitted.axis, drives_of(members, *motion.paths[t], raw, flies), pace, load);
      fitted.flight = std::make_shared<const Flight>(load.take()), fitted.flying = flies->candidate;
      std::tie(fitted.axis, fitted.gains) =
          along_flight(fitted.axis, fitted.flight, noise, model.nominal_inertia());
    } else {
      fitted.gains = gains_of(fitted.axis, noise, model.nominal_inertia());
      const Drives drives =
          motion.paths.empty()
              ? Drives{raw, std::vector<double>(raw.size(), 0.0), {}, slope_of(model.record(), raw.size())}
              : drives_of(members, *motion.paths[t], raw);
      fitted.prediction = predict(model, fitted.axis, fitted.gains, drives, pace);
    }
    fitted.white = fitted.prediction.error;
    whiten(fitted.white, fitted.gains);
    result.push_back(std::move(fitted));
  }
  return result;
}

double mean_square(const Trials& trials, const std::vector<Fitted>& fitted, bool held_out) {
  double sum = 0;
  size_t n = 0;
  for_counted_rows(trials, fitted, held_out, [&](const Fitted&, size_t, std::span<const double> white) {
    for (double e : white) sum += e * e, ++n;
  });
  return n ? sum / double(n) : 0;
}

double profile(const Trials& trials, const std::vector<Fitted>& fitted) {
  double sum = 0;
  for_counted_rows(trials, fitted, false, [&](const Fitted& f, size_t row, std::span<const double>) {
    sum += f.gains.log_determinant_at(row);
  });
  return sum + double(fitted_numbers(trials)) * std::log(mean_square(trials, fitted));
}

size_t fitted_numbers(const Trials& trials) {
  size_t n = 0;
  for (const Trial& trial : trials.list)
    for (size_t k = 0; k < trial.held_out_from; ++k) n += trial.usable[k] ? trials.ports() : 0;
  return n;
}

Sensitivity sensitivity(const std::vector<Member>& members, const Path& path, const Fitted& fitted,
                        const std::vector<double>& raw_input) {
  Sensitivity result;
  const std::vector<FreeParameter> free = free_parameters(members);
  result.columns.resize(free.size());
  Columns of_inputs;
  std::vector<Columns> of_members(members.size());
  beside_each_other(
      members,
      [&] {
        InputChain chain(path, raw_input);
        for (const FreeParameter& parameter : free)
          if (members[parameter.member].candidate->acts == Acts::input)
            of_inputs.push_back(input_derivative(members, parameter, chain));
      },
      [&](size_t m) {
        of_members[m] = members[m].candidate == fitted.flying ? flying_derivatives(members[m], fitted)
                                                              : derivatives(members[m], path);
      });
  for (const Acts acts : {Acts::force, Acts::input, Acts::sensor}) {
    Columns columns = acts == Acts::input ? std::move(of_inputs) : Columns{};
    std::vector<size_t> places;
    for (size_t i = 0; i < free.size(); ++i)
      if (members[free[i].member].candidate->acts == acts) places.push_back(i);
    for (size_t m = 0; m < members.size(); ++m)
      if (members[m].candidate->acts == acts) std::ranges::move(of_members[m], std::back_inserter(columns));
    auto response = responses(fitted.axis, fitted.gains, path, acts, pointers(columns));
    for (size_t i = 0; i < places.size(); ++i) result.columns[places[i]] = std::move(response[i]);
  }
  return result;
}

}  // namespace loopwright::diagnosis
