#include "tools/diagnose/search/catalogue.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/even_path.h"
#include "tools/effects/effect_run.h"
#include "models/real/whole.h"

namespace loopwright::diagnosis {
namespace {

using To = Attachment::To;

Acts acts(const Effect& effect) {
  for (const Attachment& a : effect.attachments) {
    if (a.to == To::input) return Acts::input;
    if (a.to == To::sensor) return Acts::sensor;
  }
  return Acts::force;
}

Attachment::Stage stage(const Effect& effect) {
  const auto at_input = std::ranges::find(effect.attachments, To::input, &Attachment::to);
  return at_input == effect.attachments.end() ? Attachment::Stage::command : at_input->stage;
}

bool adds_inertia(const Attachment& attachment) {
  return attachment.to == To::parameter &&
         std::ranges::any_of(attachment.targets, [](const std::string& target) {
           return target.starts_with("Mass.") || target.starts_with("TwoMass.");
         });
}

constexpr double linear_points = 8;
constexpr double grid_ratio = 1.7;  // between neighbors on a logarithmic scale, at most
/// [samples] The shortest delay or lag of the grid: a held force that changes from sample to sample shows a
/// delay of a tenth.
constexpr double shortest_delay = 20 / 303.75;

/// Initial values of the search. Later shapes of an effect start in the middle: the fit moves them.
std::vector<double> grid_of(const CandidateParameter& p, bool is_first, int points) {
  std::vector<double> grid;
  const double low = p.logarithmic ? std::max(p.low, 1e-6 * p.high) : p.low;
  const double n = points > 0      ? points
                   : !is_first     ? 1
                   : p.logarithmic ? std::ceil(std::log(p.high / low) / std::log(grid_ratio))
                                   : linear_points;
  for (double i = 0.5; i < n; i += 1)
    grid.push_back(p.logarithmic ? low * std::pow(p.high / low, i / n) : low + (p.high - low) * i / n);
  return grid;
}

LawOf variable_of_law(const Effect& effect) {
  LawOf of = LawOf::several;
  for (const std::string& role : effect.reads)
    if (role == "position")
      of = LawOf::position;
    else if (role != "velocity")
      return LawOf::several;
    else if (of == LawOf::several)
      of = LawOf::velocity;
  return of;
}

/// The columns used last: fits return to the same path and shape many times.
class Remembered {
 public:
  const Columns* find(const Path& path, const std::vector<double>& shape) {
    const auto entry = std::ranges::find_if(
        entries_, [&](const Entry& e) { return e.path == path.identity && e.path != 0 && e.shape == shape; });
    if (entry == entries_.end()) return nullptr;
    std::rotate(entry, entry + 1, entries_.end());
    return &entries_.back().columns;
  }
  void keep(const Path& path, const std::vector<double>& shape, const Columns& columns) {
    if (path.identity == 0) return;
    entries_.push_back({path.identity, shape, columns});
    if (entries_.size() > most) entries_.pop_front();
  }

 private:
  static constexpr size_t most = 16;
  struct Entry {
    uint64_t path;
    std::vector<double> shape;
    Columns columns;
  };
  std::deque<Entry> entries_;  // the one used last at the end
};

/// So many shapes at a time are a grid, of which only the best are run again.
constexpr size_t least_grid = 8;

/// Steps of a sample time in which a delay or a lag of the input runs along rows at uneven times. A held
/// command changes where a row begins: that instant is known to one of these parts then.
constexpr int parts_of_uneven_rows = 8;

/// An effect with the indices of its parameters.
struct Compiled {
  std::shared_ptr<const EffectPlan> plan;
  std::shared_ptr<const EffectPlan> in_parts;  ///< the same in parts of a sample time; null: no row needs it
  std::vector<size_t> linear, nonlinear;       // in EffectPlan::fitted
  Acts acts;
  Remembered remembered;
  /// By the plan, and by the number of sets that was asked for.
  std::map<std::pair<const EffectPlan*, size_t>, std::unique_ptr<EffectRun>> runs;

  /// Runs only the shapes that are not cached.
  std::vector<Columns> columns(const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result(shapes.size());
    std::vector<std::vector<double>> others;
    std::vector<size_t> places;
    for (size_t i = 0; i < shapes.size(); ++i) {
      if (const Columns* known = remembered.find(path, shapes[i]))
        result[i] = *known;
      else
        others.push_back(shapes[i]), places.push_back(i);
    }
    if (others.empty()) return result;
    std::vector<Columns> computed = run(path, others);
    for (size_t i = 0; i < others.size(); ++i) {
      if (others.size() < least_grid) remembered.keep(path, others[i], computed[i]);
      result[places[i]] = std::move(computed[i]);
    }
    return result;
  }
  /// Every linear parameter of every shape has a lane.
  std::vector<Columns> run(const Path& path, const std::vector<std::vector<double>>& shapes) {
    RoleSignals signals;
    signals.position = acts == Acts::sensor ? path.predicted_position : path.position;
    signals.velocity = path.velocity, signals.acceleration = path.acceleration;
    signals.input = path.input, signals.force = path.force, signals.velocity_bow = path.velocity_bow;
    std::optional<EvenPath> even;
    const bool is_uneven = plan->remembers && !path.duration.empty(), is_in_parts = is_uneven && in_parts;
    if (is_in_parts || (is_uneven && acts == Acts::force))
      even.emplace(path, is_in_parts ? parts_of_uneven_rows : 1), signals = even->signals();
    const size_t rows = even ? even->rows() : path.samples(), per_shape = std::max<size_t>(1, linear.size());
    const size_t wanted = shapes.size() * per_shape;
    std::vector<Columns> result(shapes.size());
    const bool is_coarse = shapes.size() >= least_grid && plan->coarser;
    EffectRun& run = run_for(is_in_parts ? in_parts : is_coarse ? plan->coarser : plan, wanted);
    const size_t lanes = size_t(run.lanes());
    for (size_t first = 0; first < wanted; first += lanes) {
      std::vector<EffectRun::Output> outputs(std::min(lanes, wanted - first));
      for (size_t lane = 0; lane < outputs.size(); ++lane) {
        const std::vector<double>& shape = shapes[(first + lane) / per_shape];
        for (size_t i = 0; i < nonlinear.size(); ++i) run.set(nonlinear[i], shape[i], int(lane));
        const double size = linear.empty() ? 1 : run.isolate(linear[(first + lane) % per_shape], int(lane));
        // What the effect adds to the input counts as negative consumption.
        outputs[lane].factor = (acts == Acts::input ? -1.0 : 1.0) / size;
      }
      run.run(signals, rows, outputs);
      for (size_t lane = 0; lane < outputs.size(); ++lane) {
        auto& [factor, mean, slope] = outputs[lane];
        if (even) even->to_rows(mean, slope);
        if (std::ranges::all_of(slope, [](float s) { return s == 0; })) slope.clear();
        result[(first + lane) / per_shape].emplace_back(std::move(mean), std::move(slope));
      }
    }
    return result;
  }
  EffectRun& run_for(const std::shared_ptr<const EffectPlan>& which, size_t sets) {
    std::unique_ptr<EffectRun>& run = runs[{which.get(), sets}];
    if (!run) run = std::make_unique<EffectRun>(which, int(sets));
    return *run;
  }
  std::vector<double> fitted_of(const Member& member) const {
    std::vector<double> fitted(plan->fitted.size());
    for (size_t i = 0; i < linear.size(); ++i) fitted[linear[i]] = member.linear[i];
    for (size_t i = 0; i < nonlinear.size(); ++i) fitted[nonlinear[i]] = member.nonlinear[i];
    return fitted;
  }
  EffectValues values(const Member& member) const {
    return values_of(plan->effect, plan->sizes, fitted_of(member));
  }
  /// At the values of a member.
  SampleMap sample_map(const Member& member) const {
    EffectSample sample(plan);
    sample.start(fitted_of(member), 0, 0);
    return sample.map();
  }
  double added_inertia(const Member& member) const {
    double sum = 0;
    for (const Attachment& a : plan->effect.attachments)
      if (adds_inertia(a)) sum += values(member).evaluate(a.add);
    return sum;
  }
  bool is_plausible(const Member& member) const {
    const EffectValues now = values(member);
    return std::ranges::all_of(plan->effect.parameters, [&](const EffectParameter& p) {
      return !p.is_bounded ||
             (now.at(p.name) >= now.evaluate(p.low) && now.at(p.name) <= now.evaluate(p.high));
    });
  }
};

Candidate candidate_of(const Effect& effect, std::shared_ptr<const EffectPlan> plan,
                       std::shared_ptr<const EffectPlan> in_parts) {
  auto compiled = std::make_shared<Compiled>();
  compiled->plan = std::move(plan), compiled->in_parts = std::move(in_parts), compiled->acts = acts(effect);
  Candidate candidate;
  candidate.name = effect.name, candidate.form = effect.form, candidate.acts = compiled->acts;
  candidate.stage = stage(effect);
  for (const EffectParameter& p : effect.parameters) {
    if (!p.is_fitted) continue;
    const FitRange range = range_of(p, compiled->plan->sizes);
    const size_t index =
        size_t(std::ranges::find(compiled->plan->fitted, p.name) - compiled->plan->fitted.begin());
    CandidateParameter parameter{
        p.name, p.unit, range.low, range.high, p.scale == EffectParameter::Scale::logarithmic, {}};
    parameter.start = range.start;
    if (p.is_linear) {
      candidate.linear.push_back(parameter), compiled->linear.push_back(index);
      continue;
    }
    candidate.is_periodic |= p.is_period;
    if (p.is_period) {
      const RecordSizes& sizes = compiled->plan->sizes;
      parameter.span = sizes.stroke;
      parameter.centre = 0.5 * (sizes.lowest_position + sizes.highest_position);
      parameter.low = std::max(parameter.low, shortest_pitch(sizes));
      candidate.fine_pitch = fine_pitch(sizes);
      parameter.high = std::max(parameter.high, 2 * parameter.low);
    }
    parameter.grid = grid_of(parameter, candidate.nonlinear.empty(), p.points);
    candidate.nonlinear.push_back(parameter), compiled->nonlinear.push_back(index);
  }
  candidate.amplitude_is_one = candidate.linear.empty();
  if (candidate.amplitude_is_one) {  // from zero to the full value: a shape near zero would explain nothing
    std::vector<double>& grid = candidate.nonlinear.front().grid;
    const double high = candidate.nonlinear.front().high;
    grid.clear();
    const double low =
        std::max(candidate.nonlinear.front().low, shortest_delay * compiled->plan->sizes.sample_time);
    for (double value = low; value < high; value *= 1.5) grid.push_back(value);
  }
  candidate.is_repeatable = effect.is_repeatable, candidate.at_rest = effect.at_rest;
  candidate.flies = candidate.acts == Acts::force && compiled->plan->flies;
  if (candidate.acts == Acts::force && !compiled->plan->remembers) candidate.law_of = variable_of_law(effect);
  candidate.columns_at = [compiled](const Path& path, const std::vector<std::vector<double>>& shapes) {
    return compiled->columns(path, shapes);
  };
  if (std::ranges::any_of(effect.parameters, &EffectParameter::is_bounded))
    candidate.is_plausible = [compiled](const Member& member) { return compiled->is_plausible(member); };
  const int own_states = compiled->plan->plan.states - 1;  // without the integral of the force
  if (candidate.acts == Acts::force && compiled->plan->is_switched && own_states <= most_load_states)
    candidate.switched_load = [compiled](const Member& member) {
      return std::make_unique<SwitchedSample>(compiled->plan, compiled->fitted_of(member));
    };
  if (candidate.acts == Acts::force && compiled->plan->is_linear)
    candidate.linear_load = [compiled](const Member& member) { return compiled->sample_map(member); };
  if (std::ranges::any_of(effect.attachments, adds_inertia))
    candidate.added_inertia = [compiled](const Member& member) { return compiled->added_inertia(member); };
  return candidate;
}

/// Why it cannot be fitted: what these records do not determine, or nothing free; empty: all are numbers.
std::string unknown_number(const Effect& effect, const RecordSizes& sizes) {
  if (std::ranges::none_of(effect.parameters, &EffectParameter::is_fitted))
    return "it has no parameter that is fitted";
  std::vector<double> starts;
  for (const EffectParameter& p : effect.parameters) {
    if (!p.is_fitted) continue;
    const FitRange range = range_of(p, sizes);
    if (!std::isfinite(range.low + range.high + range.start) || !(range.low < range.high))
      return fmt::format("the range of \"{}\" cannot be worked out from these records", p.name);
    starts.push_back(range.start);
  }
  const EffectValues values = values_of(effect, sizes, starts);
  for (const EffectParameter& p : effect.parameters)
    if (!std::isfinite(values.at(p.name)))
      return fmt::format("\"{}\" cannot be worked out from these records", p.name);
  return {};
}

/// Effects with the same reason together, each once.
void leave_out(std::vector<NotLookedFor>& list, const std::string& effect, std::string why) {
  auto same = std::ranges::find(list, why, &NotLookedFor::why);
  if (same == list.end()) same = list.insert(same, {{}, std::move(why)});
  if (std::ranges::find(same->effects, effect) == same->effects.end()) same->effects.push_back(effect);
}

}  // namespace

bool has_uneven_rows(const std::vector<std::shared_ptr<const Path>>& paths) {
  return std::ranges::any_of(paths, [](const auto& path) { return !path->duration.empty(); });
}

std::string not_in_a_map(const Effect& effect) {
  const Excitation& needs = effect.needs;
  const bool needs_motion = needs.speeds > 1 || needs.accelerations > 0 || needs.passes > 1 ||
                            needs.reversals > 0 || needs.varied_force;
  return needs_motion ? "a map of balances has neither speeds nor times" : "";
}

namespace {

bool is_late(const Effect& effect) {
  return acts(effect) == Acts::input && std::ranges::none_of(effect.parameters, &EffectParameter::is_linear);
}

}  // namespace

std::string hidden_by_input_noise(const Effect& effect) {
  return is_late(effect) ? "the noise of the recorded input hides when it acts" : "";
}

std::string hidden_by_controller(const Effect& effect) {
  return is_late(effect)
             ? "a controller has readings that the rows of the record lack, and what it does about noise "
               "that they do not show yet looks like it"
             : "";
}

Catalogue make_catalogue(const std::vector<std::string>& folders, const MachineUnits& units,
                         const RecordSizes& of_records, const WhyNot& why_not, bool rows_are_uneven) {
  Problems problems;
  RecordSizes sizes = of_records;
  sizes.start = 0;  // candidates run from the first row on
  RecordSizes sizes_in_parts = sizes;
  sizes_in_parts.sample_time /= parts_of_uneven_rows;
  Catalogue catalogue;
  for (Effect& effect : load_catalogue(folders, problems)) {
    std::string why = unknown_number(effect, sizes);
    if (why.empty()) why = why_not(effect);
    if (!why.empty()) {
      leave_out(catalogue.left_out, effect.name, std::move(why));
    } else if (auto plan = compile_effect(effect, units, sizes, problems)) {
      const bool needs_parts = rows_are_uneven && plan->remembers && is_late(effect);
      catalogue.candidates.push_back(
          candidate_of(effect, std::move(plan),
                       needs_parts ? compile_effect(effect, units, sizes_in_parts, problems) : nullptr));
      catalogue.effects.push_back(std::move(effect));
    }
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  return catalogue;
}

}  // namespace loopwright::diagnosis
