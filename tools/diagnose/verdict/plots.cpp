#include "tools/diagnose/verdict/plots.h"
#include <algorithm>
#include <cmath>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "models/real/whole.h"
#include "tools/diagnose/search/whiteness.h"
#include "tools/draw/diagram_graph.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t usual_ranges = 120;   // of a variable, in each of which the shape is one mean
constexpr size_t ranges_a_pitch = 16;  // of a shape that repeats: fewer would draw a beat in its place
constexpr double least_rows = 3;       // of such a mean
/// [share] Of a force that is determined by the motion so far: over the time of a short record any force
/// would be determined.
constexpr double determined_by_motion = 0.8;

/// Means of `values` over equal ranges of the variable.
struct Means {
  std::vector<double> at, mean;
  double explained = 0;  ///< share of the values' squares
};

/// `pitch`: with which the values repeat along the variable; 0: they do not. Where the rows are too few to
/// show each period, there are as many ranges as they fill.
Means means_over(const std::vector<double>& variable, const std::vector<double>& values,
                 const std::vector<char>& counts, double pitch) {
  double low = INFINITY, high = -INFINITY;
  for (size_t k = 0; k < variable.size(); ++k)
    if (counts[k]) low = std::min(low, variable[k]), high = std::max(high, variable[k]);
  Means result;
  if (!(high > low)) return result;
  struct Range {
    double at = 0, sum = 0, n = 0;
  };
  size_t ranges = usual_ranges;
  if (pitch > 0) {
    const size_t most = std::max(usual_ranges, size_t(double(variable.size()) / least_rows));
    ranges = std::clamp(whole_count(double(ranges_a_pitch) * (high - low) / pitch), usual_ranges, most);
  }
  std::vector<Range> list(ranges);
  double squares = 0;
  for (size_t k = 0; k < variable.size(); ++k) {
    if (!counts[k]) continue;
    const double place = (variable[k] - low) / (high - low) * double(ranges);
    Range& range = list[std::min(ranges - 1, size_t(place))];
    range.at += variable[k], range.sum += values[k], range.n += 1;
    squares += values[k] * values[k];
  }
  double kept = 0;
  for (const Range& range : list) {
    if (range.n < least_rows) continue;
    result.at.push_back(range.at / range.n), result.mean.push_back(range.sum / range.n);
    kept += range.sum * range.sum / range.n;
  }
  result.explained = squares > 0 ? kept / squares : 0;
  return result;
}

struct DrawnVariable {
  const char* name;
  std::string unit;
  const std::vector<double>* values;
};

std::vector<DrawnVariable> variables_of(const InverseDynamics& inverse, bool is_map,
                                        const MachineUnits& units) {
  std::vector<DrawnVariable> list{{"Position", units.position, &inverse.path.position}};
  if (is_map) return list;
  list.push_back({"Velocity", units.position + "/s", &inverse.path.velocity});
  list.push_back({"Acceleration", units.position + "/s^2", &inverse.motion.acceleration});
  list.push_back({"Input", units.input, &inverse.path.input});
  list.push_back({"Time", "s", &inverse.motion.time});
  return list;
}

std::string role_of(const Candidate& candidate) {
  return candidate.acts == Acts::input ? "input" : candidate.acts == Acts::sensor ? "position" : "force";
}

/// Of the first port, at one to forty lags.
std::vector<double> correlations(const Trials& trials, const std::vector<Fitted>& fitted) {
  const std::vector<double> squares = lagged_products(trials, fitted, 0, rows_in_a_lag(trials)).sum;
  std::vector<double> list;
  for (size_t lag = 1; lag < squares.size(); ++lag)
    list.push_back(squares[0] > 0 ? squares[lag] / squares[0] : 0);
  return list;
}

/// The force that the diagram lacks, without and with the members.
Diagnosis::Curves residual_curves(const Trials& trials, const InverseDynamics& inverse,
                                  const std::vector<Member>& members) {
  Diagnosis::Curves curves;
  curves.position = inverse.path.position;
  curves.before = residual_with(trials.list.front(), inverse, {});
  curves.after = residual_with(trials.list.front(), inverse, members);
  if (!trials.has_map()) curves.velocity = inverse.path.velocity, curves.time = inverse.motion.time;
  for (size_t k = 0; k < inverse.motion.rows(); ++k)
    if (!inverse.motion.counts[k]) curves.before[k] = curves.after[k] = std::nan("");
  return curves;
}

/// What all others leave of the force, and the member's own force, for every member with a name.
std::vector<MissingTerm> missing_terms(const Trials& trials, const InverseDynamics& inverse,
                                       const std::vector<Member>& members,
                                       const std::vector<std::pair<std::string, std::string>>& role_ports,
                                       const MachineUnits& units) {
  std::vector<MissingTerm> terms;
  const Trial& trial = trials.list.front();
  const std::vector<double> left = residual_with(trial, inverse, members);
  for (size_t m = 0; m < members.size(); ++m) {
    const Candidate& candidate = *members[m].candidate;
    if (candidate.is_unknown) continue;
    std::vector<Member> others = members;
    others.erase(others.begin() + std::ptrdiff_t(m));
    MissingTerm term{candidate.name, {}, {}, {}, {}, residual_with(trial, inverse, others), {}, {}, {}};
    std::vector<double> force(left.size());
    for (size_t k = 0; k < force.size(); ++k) force[k] = term.found[k] - left[k];
    double most = -1;
    for (const DrawnVariable& v : variables_of(inverse, trials.has_map(), units)) {
      if (v.values == &inverse.motion.time && most > determined_by_motion) continue;
      const bool repeats = candidate.is_periodic && v.values == &inverse.path.position;
      Means means =
          means_over(*v.values, force, inverse.motion.counts, repeats ? members[m].nonlinear.front() : 0);
      if (means.explained <= most) continue;
      most = means.explained, term.variable = v.name, term.unit = v.unit, term.at = *v.values;
      term.shape_at = std::move(means.at), term.shape = std::move(means.mean);
    }
    for (size_t k = 0; k < force.size(); ++k)
      if (!inverse.motion.counts[k]) term.found[k] = std::nan("");
    for (const auto& [role, port] : role_ports)
      if (role == role_of(candidate)) term.site = port;
    term.site_unit = units.force;
    terms.push_back(std::move(term));
  }
  return terms;
}

/// Of the first port: with the noise of the estimate, without and with its members.
Diagnosis::Whiteness whiteness_of(Trials& trials, const Estimate& estimate) {
  Diagnosis::Whiteness result;
  const double sample_time = trials.list.front().model->record().sample_time;
  const LaggedProducts products = lagged_products(trials, *estimate.fitted, 0, rows_in_a_lag(trials));
  result.after = correlations(trials, *estimate.fitted);
  result.before = correlations(trials, run_members(trials, {}, {}, estimate.noise));
  for (size_t lag = 1; lag <= result.after.size(); ++lag)
    result.lag_s.push_back(double(lag * rows_in_a_lag(trials)) * sample_time);
  result.most = products.rows > 0 ? 1.96 / std::sqrt(products.rows) : 0;
  return result;
}

}  // namespace

report::Graph picture_of(const Improvement& improved, const LoadOptions& load) {
  Problems problems;
  const Value root = parse_json(improved.file, problems);
  const auto diagram = read_diagram(root, improved.file->name, load, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  if (!plan || problems.has_errors()) return {};
  report::Graph graph = diagram_graph(*diagram, *plan);
  for (report::GraphNode& node : graph.nodes)
    if (std::ranges::find(improved.blocks, node.path) != improved.blocks.end()) node.room = "added";
  return graph;
}

void add_plots(Trials& trials, const InverseDynamics& first_record, const Acceptance& accepted,
               const Improver& improver, const MachineUnits& units, const LoadOptions& load,
               Diagnosis& result) {
  const Staircase& staircase = accepted.staircase;
  result.curves = residual_curves(trials, first_record, accepted.conclusion.estimate.members);
  if (!trials.has_map()) result.whiteness = whiteness_of(trials, accepted.conclusion.estimate);
  if (result.effects.empty()) return;
  const std::vector<Member>& members = staircase.members[staircase.necessary() - 1];
  result.terms =
      missing_terms(trials, first_record, members, improver.experiments().front()->roles.ports, units);
  result.picture = picture_of(improver.with(members), load);
}

}  // namespace loopwright::diagnosis
