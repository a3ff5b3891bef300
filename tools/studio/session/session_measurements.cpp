/// Records: their columns, experiment files, and the comparison with the diagram.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include "engine/diagram/in_memory.h"
#include "engine/json/reader.h"
#include "engine/record/recording_file.h"
#include "tools/compare/compare.h"
#include "tools/experiment/experiment_ports.h"
#include "tools/report/thin.h"
#include "tools/studio/session/column_match.h"
#include "tools/studio/session/experiment_text.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {
namespace {

std::string experiment_name(const std::string& data) {
  return data.substr(0, data.rfind('.')) + ".experiment.json";
}

Json column_json(const ColumnGuess& guess) {
  return {{"column", guess.column},    {"name", guess.name},
          {"unit", guess.unit},        {"unit_is_stated", guess.unit_is_stated},
          {"min", finite(guess.low)},  {"max", finite(guess.high)},
          {"use", name_of(guess.use)}, {"port", guess.port},
          {"why", guess.why},          {"resolution", guess.resolution},
          {"interpolation", "hold"},   {"candidates", guess.candidates}};
}

/// The time column in s, as far as a summary needs it.
void add_times(const Recording& record, const ColumnGuess& guess, Json& json) {
  const Column* time = record.find(guess.column);
  if (!time || time->values.empty()) return;
  const auto unit = parse_unit(guess.unit.empty() ? "s" : guess.unit);
  const double scale = unit && unit->same_dimension(*parse_unit("s")) ? unit->scale : 1;
  json["start"] = finite(time->values.front() * scale), json["stop"] = finite(time->values.back() * scale);
  const double rows = double(time->values.size());
  json["sample_time"] =
      rows > 1 ? finite((time->values.back() - time->values.front()) * scale / (rows - 1)) : Json(0);
}

/// A cloud of points with at most `most` of them, evenly taken.
Json cloud(const std::vector<double>& x, const std::vector<double>& y, const std::vector<char>* counts,
           size_t most) {
  std::vector<size_t> rows;
  for (size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if ((!counts || (*counts)[k]) && std::isfinite(y[k])) rows.push_back(k);
  const size_t step = std::max<size_t>(1, rows.size() / std::max<size_t>(most, 1));
  std::vector<double> xs, ys;
  for (size_t i = 0; i < rows.size(); i += step) xs.push_back(x[rows[i]]), ys.push_back(y[rows[i]]);
  return {{"x", std::move(xs)}, {"y", std::move(ys)}};
}

Json residual_json(const char* against, const std::string& unit, const std::string& of,
                   const std::string& of_unit, Json curve, bool is_cloud) {
  return {{"against", against},       {"unit", unit == "1" ? "" : unit}, {"of", of},
          {"residual_unit", of_unit}, {"x", std::move(curve["x"])},      {"y", std::move(curve["y"])},
          {"points", is_cloud}};
}

Json residuals(const Comparison& comparison, size_t points) {
  Json list = Json::array();
  if (comparison.force) {
    const ForceAnalysis& f = *comparison.force;
    const std::string& unit = f.motion.force_unit;
    list.push_back(residual_json("time", "s", "missing force", unit,
                                 thinned_curve(f.motion.time, f.residual.value, points), false));
    list.push_back(residual_json("position", f.motion.position_unit, "missing force", unit,
                                 cloud(f.motion.position, f.residual.value, &f.motion.counts, 2 * points),
                                 true));
    list.push_back(residual_json("velocity", f.motion.position_unit + "/s", "missing force", unit,
                                 cloud(f.motion.velocity, f.residual.value, &f.motion.counts, 2 * points),
                                 true));
    list.push_back(residual_json("acceleration", f.motion.position_unit + "/s^2", "missing force", unit,
                                 cloud(f.motion.acceleration, f.residual.value, &f.motion.counts, 2 * points),
                                 true));
    return list;
  }
  if (comparison.signals.empty()) return list;
  const ComparedSignal& signal = comparison.signals.front();
  const std::string of = "error of " + signal.name;
  list.push_back(residual_json("time", "s", of, signal.unit,
                               thinned_curve(picked(signal.rows, comparison.time), signal.error, points),
                               false));
  if (!comparison.position.empty())
    list.push_back(residual_json(
        "position", comparison.position_unit, of, signal.unit,
        cloud(picked(signal.rows, comparison.position), signal.error, nullptr, 2 * points), true));
  if (!comparison.velocity.empty())
    list.push_back(residual_json(
        "velocity", comparison.velocity_unit, of, signal.unit,
        cloud(picked(signal.rows, comparison.velocity), signal.error, nullptr, 2 * points), true));
  return list;
}

Json force_json(const ForceAnalysis& f) {
  Json json{{"rmse", f.residual.rmse},
            {"relative", f.residual.relative_percent},
            {"noise_floor", f.residual.noise_floor},
            {"floor_source", f.residual.floor_source},
            {"unit", f.motion.force_unit},
            {"where", Json::array()},
            {"dependence", Json::array()},
            {"faults", Json::array()}};
  for (const ResidualShare& share : f.where)
    json["where"].push_back({{"axis", share.axis},
                             {"label", share.label},
                             {"from", share.from},
                             {"to", share.to},
                             {"share", share.share},
                             {"of_rows", share.of_rows}});
  for (const Dependence& dependence : f.dependence)
    json["dependence"].push_back({{"variable", dependence.variable}, {"share", dependence.share}});
  for (const RecordFault& fault : f.faults)
    json["faults"].push_back({{"name", fault.name}, {"text", fault.text}, {"cost", fault.cost}});
  return json;
}

/// As the page shows it: "2.35 %", "1971 %".
std::string percent(double number) {
  return number >= 100 ? fmt::format("{:.0f} %", number) : fmt::format("{:.3g} %", number);
}

/// Where the diagram fails: the machine by its missing force, other blocks by the error of their signals.
Json tint(const Comparison& comparison, const Experiment& experiment) {
  std::map<std::string, std::pair<double, std::string>> shares;
  const auto add = [&](const std::string& port, double share, const std::string& text) {
    for (std::string path = port; path.find('.') != path.npos;) {
      path.resize(path.rfind('.'));
      auto& entry = shares[path];
      if (share > entry.first) entry = {share, text};
    }
  };
  // The missing force says where: positions in an open loop drift whatever is missing, even noise.
  if (!comparison.force)
    for (const ComparedSignal& signal : comparison.signals)
      add(signal.name, std::min(1.0, signal.relative_percent / 100),
          fmt::format("{} is off by {} (rms)", signal.name, percent(signal.relative_percent)));
  if (comparison.force) {
    std::string on;
    double most = 0;
    for (const Dependence& dependence : comparison.force->dependence)
      if (dependence.share > most && dependence.variable.find("frequency") == std::string::npos)
        most = dependence.share,
        on = fmt::format("; {:.0f} % of it depends on {}", 100 * most, dependence.variable);
    for (const auto& [role, port] : experiment.roles.ports)
      if (role == "force")
        add(port, std::min(1.0, comparison.force->residual.relative_percent / 100),
            fmt::format("{} of the driving force is missing here{}",
                        percent(comparison.force->residual.relative_percent), on));
  }
  Json list = Json::array();
  for (const auto& [block, entry] : shares)
    list.push_back({{"block", block}, {"share", entry.first}, {"text", entry.second}});
  return list;
}

/// Between the readings of a slower signal the lines with which it is drawn.
std::vector<double> in_all_rows(const SlowerRows& rows, std::vector<double>&& readings, size_t count) {
  if (rows.are_all() || readings.empty()) return std::move(readings);
  std::vector<double> values;
  for (size_t row = 0; row < count; ++row) {
    const size_t since = row - std::min(row, rows.first), last = readings.size() - 1,
                 before = std::min(since / rows.every, last);
    const double part = before < last ? double(since % rows.every) / double(rows.every) : 0;
    values.push_back(readings[before] + (part > 0 ? part * (readings[before + 1] - readings[before]) : 0));
  }
  return values;
}

/// Takes the samples: those of a long record are not in memory twice.
std::shared_ptr<const Signals> signals_of(Comparison&& comparison) {
  Recording recording;
  const size_t rows = comparison.time.size();
  recording.columns.push_back({"time", "s", std::move(comparison.time), ""});
  for (ComparedSignal& signal : comparison.signals)
    for (const auto& [what, values] : {std::pair("measured ", &signal.measured),
                                       {"simulated ", &signal.simulated},
                                       {"error ", &signal.error}})
      recording.columns.push_back(
          {what + signal.name, signal.unit, in_all_rows(signal.rows, std::move(*values), rows), ""});
  return std::make_shared<Signals>(std::move(recording));
}

/// One set of rows for the three curves: those that draw the error, and those that draw the measurement.
void add_curves(const std::vector<double>& time, const ComparedSignal& signal, size_t points, Json& entry) {
  const std::vector<size_t> of_error = report::thin(signal.error, points),
                            measured = report::thin(signal.measured, points);
  std::vector<size_t> rows;
  std::ranges::set_union(of_error, measured, std::back_inserter(rows));
  const auto taken = [&](const std::vector<double>& values) {
    std::vector<double> some;
    for (size_t row : rows) some.push_back(values[row]);
    return some;
  };
  entry["x"] = taken(time), entry["measured"] = taken(signal.measured);
  entry["simulated"] = taken(signal.simulated), entry["error"] = taken(signal.error);
}

Json comparison_json(const Comparison& comparison, const Experiment& experiment, size_t points) {
  static constexpr std::string_view statuses[] = {"finished", "failed", "interrupted"};
  Json json{{"title", comparison.plan->title},
            {"status", statuses[size_t(comparison.run.status)]},
            {"message", printable(comparison.run.message)},
            {"warnings", comparison.warnings},
            {"text", to_text(comparison)},
            {"signals", Json::array()},
            {"residual", residuals(comparison, points)},
            {"force", comparison.force ? force_json(*comparison.force) : Json(nullptr)},
            {"why_no_force", comparison.why_no_force},
            {"drives", experiment.drives.size()},
            {"tint", tint(comparison, experiment)}};
  for (const ComparedSignal& signal : comparison.signals) {
    Json entry{{"name", signal.name},
               {"unit", signal.unit},
               {"rmse", signal.rmse},
               {"max", signal.max_abs},
               {"mean", signal.mean},
               {"fit", signal.fit_percent},
               {"relative", signal.relative_percent},
               {"held_out", signal.held_out_rmse},
               {"resolution", signal.resolution}};
    add_curves(picked(signal.rows, comparison.time), signal, points, entry);
    json["signals"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace

Json Session::columns(const Request& request) {
  const auto file = source(request.required("path"));
  const std::string data = request.required("data"), path = folder_.path_of(data);
  const std::string experiment = experiment_name(data);
  const bool exists = folder_.read(experiment).has_value();
  const LoadOptions options = request.options();
  return start(request, [=](Work&) -> Json {
    Problems problems;
    const Recording record = read_recording(path, problems, {.allow_not_finite = true, .allow_holes = true});
    const auto diagram = load_diagram_text(file, options, problems);
    const auto plan = diagram ? compile(*diagram, problems) : nullptr;
    if (!plan || record.columns.empty()) throw InputError(std::move(problems));
    const std::vector<PortOfDiagram> ports = ports_of(*plan, *diagram);
    const std::vector<RoleGuess> roles = guess_roles(*plan, ports);
    Json json{
        {"data", data},           {"rows", record.rows()},  {"time", ""},       {"columns", Json::array()},
        {"ports", Json::array()}, {"roles", Json::array()}, {"hold_out", 0.25}, {"experiment", experiment},
        {"exists", exists}};
    for (const ColumnGuess& guess : guess_columns(record, ports, roles)) {
      if (guess.use == ColumnGuess::Use::time) json["time"] = guess.column, add_times(record, guess, json);
      json["columns"].push_back(column_json(guess));
    }
    constexpr size_t most_ports = 3000;
    for (const PortOfDiagram& port : ports)
      if (json["ports"].size() < most_ports)
        json["ports"].push_back({{"port", port.path},
                                 {"unit", port.unit ? to_string(*port.unit) : ""},
                                 {"input", port.is_input}});
    for (const RoleGuess& role : roles)
      json["roles"].push_back({{"role", role.role}, {"port", role.port}, {"why", role.why}});
    return json;
  });
}

Json Session::write_experiment(const Request& request) {
  const auto file = source(request.required("path"));
  const std::string target = request.required("experiment"), data = request.required("data");
  if (!target.ends_with(".experiment.json"))
    throw Refused("the name of an experiment ends with .experiment.json");
  const std::filesystem::path beside = std::filesystem::path(target).parent_path();
  const std::string named =
      std::filesystem::path(data).lexically_relative(beside.empty() ? "." : beside).generic_string();
  const std::optional<std::string> before = folder_.read(target);
  const ParsedText replaced(folder_.path_of(target), before.value_or("{}"));
  const std::string text = experiment_text(request.message, named, replaced.root);
  if (before && *before != text && !request.flag("replace"))
    throw Refused(fmt::format("\"{}\" is there already", target));
  if (folder_.replace(target, before, text))
    throw Refused(fmt::format("\"{}\" was changed at the same moment", target));
  Problems problems;
  const auto experiment = load_experiment(folder_.path_of(target), problems);
  if (experiment) {
    const auto diagram = load_diagram_text(file, follow(*experiment, request.options()), problems);
    const auto plan = diagram ? compile(*diagram, problems) : nullptr;
    if (plan) logging(*plan, in_units_of_ports(*plan, *experiment), problems);
  }
  const ParsedText parsed(folder_.path_of(target), text);
  Json list = problems_json(problems.list(), parsed, folder_.path());
  if (problems.has_errors()) {
    if (before)
      folder_.replace(target, text, *before);
    else
      folder_.remove(target, text);
  }
  return {{"experiment", target},
          {"written", !problems.has_errors()},
          {"text", text},
          {"problems", std::move(list)}};
}

Json Session::compare(const Request& request) {
  const std::string path = file_of(request),
                    experiment_path = folder_.path_of(request.required("experiment"));
  const LoadOptions options = request.options();
  const size_t points = size_t(std::clamp<int64_t>(request.whole("points", 1200), 10, 20'000));
  return start(request, [=, this](Work& work) -> Json {
    RunOptions run_options;
    run_options.interrupt = &work.job.interrupt();
    run_options.progress = [&](double time, double stop) {
      work.progress("run", stop > 0 ? time / stop : 0);
    };
    Comparison comparison = loopwright::compare(path, experiment_path, options, run_options);
    Problems problems;
    const auto experiment = read_experiment(experiment_path, problems);
    if (!experiment) throw InputError(std::move(problems));
    Json json = comparison_json(comparison, *experiment, points);
    json["comparison"] = results_.comparisons.add(
        std::make_shared<StoredComparison>(StoredComparison{signals_of(std::move(comparison))}));
    return json;
  });
}

}  // namespace loopwright::studio
