/// Runs and their signals.
#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include "engine/diagram/in_memory.h"
#include "engine/json/reader.h"
#include "engine/record/recording_file.h"
#include "engine/record/column_units.h"
#include "tools/experiment/experiment.h"
#include "tools/run/judged_run.h"
#include "tools/run/run_page.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/kept_runs.h"
#include "tools/studio/session/session.h"
#include "tools/studio/session/shell_command.h"

namespace loopwright::studio {
namespace {

std::string command_of(const std::string& path, const LoadOptions& options) {
  return "loopwright run " + shell_word(path) + options_text(options);
}

std::string now_text() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

std::string_view name_of(RunStatus status) {
  static constexpr std::string_view names[] = {"finished", "failed", "interrupted"};
  return names[size_t(status)];
}

std::set<std::string> held_signals(const Plan& plan) {
  std::set<std::string> held;
  for (const Plan::Logged& logged : plan.log)
    if (logged.rate.kind == Rate::Kind::sampled) held.insert(logged.name);
  return held;
}

/// The plan with ports that are recorded in addition to the log; an unknown one throws Refused.
Plan recording(const Plan& plan, const std::vector<std::string>& signals) {
  Plan more = plan;
  for (const std::string& name : signals) {
    const bool is_there = std::ranges::any_of(more.log, [&](const Plan::Logged& logged) {
      return logged.name == name || logged.name.starts_with(name + "[");
    });
    if (is_there) continue;
    const std::vector<Number> numbers = plan.find(name);
    if (numbers.empty()) throw Refused(fmt::format("there is no port \"{}\"", name));
    for (size_t i = 0; i < numbers.size(); ++i) {
      Plan::Logged logged;
      logged.name = numbers.size() == 1 ? name : fmt::format("{}[{}]", name, i);
      const auto unit = plan.unit_of(numbers[i]);
      logged.unit = unit.value_or(Unit{}), logged.unit_is_known = unit.has_value();
      logged.number = numbers[i], logged.rate = {Rate::Kind::continuous, 0, 0};
      if (const auto [block, output] = plan.source_of(numbers[i]);
          block >= 0 && plan.blocks[size_t(block)].period > 0)
        logged.rate.kind = Rate::Kind::sampled;
      more.log.push_back(std::move(logged));
    }
  }
  return more;
}

/// Of the plan that this text gives now; empty if it gives none.
std::string present_hash(const std::shared_ptr<const SourceFile>& file, const LoadOptions& options) {
  if (!file) return "";
  Problems problems;
  const auto diagram = load_diagram_text(file, options, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  return plan && !problems.has_errors() ? plan->hash : "";
}

/// The most important sentence first.
Json verdict_json(const std::vector<report::Notice>& notices) {
  static constexpr std::string_view names[] = {"note", "good", "warning", "error"};
  Json list = Json::array();
  for (const report::Notice& notice : notices)
    list.push_back({{"severity", names[size_t(notice.severity)]}, {"text", notice.text}});
  return list;
}

/// A diagram as an experiment or the studio asks for it.
struct Runnable {
  std::shared_ptr<const Diagram> diagram;
  std::shared_ptr<const Plan> plan;
  LoadOptions load;
};

/// Throws InputError. `experiment`: what it drives is followed; empty: none.
Runnable runnable(const std::shared_ptr<const SourceFile>& file, LoadOptions load,
                  const std::string& experiment) {
  Problems problems;
  if (!experiment.empty()) {
    const auto recorded = load_experiment(experiment, problems);
    if (!recorded) throw InputError(std::move(problems));
    load = follow(*recorded, load);
  }
  const auto diagram = load_diagram_text(file, load, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  if (!plan || problems.has_errors()) throw InputError(std::move(problems));
  return {diagram, plan, std::move(load)};
}

/// What is told of a run beside its signals, and where it came from.
Json facts_of(const Plan& plan, const JudgedRun& run) {
  return {{"run", 0},
          {"name", ""},
          {"note", ""},
          {"when", now_text()},
          {"status", name_of(run.result.status)},
          {"message", printable(run.result.message)},
          {"time", run.result.time},
          {"wall", run.result.statistics.wall_seconds},
          {"hash", plan.hash},
          {"warnings", run.result.warnings},
          {"summary", run_summary(plan, run.result, run.figures)},
          {"verdict", verdict_json(verdict(plan, run.result, run.figures))}};
}

/// Figures of each signal, for a table of runs.
Json merit_of(const Json& signals) {
  Json merit = Json::array();
  for (const Json& signal : signals)
    merit.push_back(
        {{"name", signal["name"]},
         {"unit", signal["unit"]},
         {"rms", signal["rms"]},
         {"max", std::max(std::abs(signal["min"].get<double>()), std::abs(signal["max"].get<double>()))}});
  return merit;
}

Window window_of(size_t points, std::vector<std::string> names) {
  return {std::move(names), -INFINITY, INFINITY, points};
}

size_t pixels(int64_t asked) { return size_t(std::clamp<int64_t>(asked, 10, 20'000)); }

}  // namespace

std::shared_ptr<const SourceFile> Session::source(const std::string& path) {
  return std::make_shared<SourceFile>(SourceFile{folder_.path_of(path), document(path).text()});
}

Json Session::run(const Request& request) {
  const std::string path = request.required("path");
  const auto file = source(path);
  const LoadOptions options = request.options();
  const std::vector<std::string> signals = request.texts("signals");
  const size_t points = pixels(request.whole("points", 1200));
  const std::string experiment_path = request.text("experiment");
  const std::string experiment = experiment_path.empty() ? "" : folder_.path_of(experiment_path);
  const std::map<std::string, std::string> set = request.text_map("set");
  return start(request, [=, this](Work& work) {
    const auto [diagram, compiled, load] = runnable(file, options, experiment);
    const Plan plan = recording(*compiled, signals);
    RunOptions run_options;
    run_options.interrupt = &work.job.interrupt();
    run_options.progress = [&work, told = 0.0](double time, double stop) mutable {
      if (time - told < 0.05 * stop) return;
      told = time;
      work.progress("run", stop > 0 ? time / stop : 0);
    };
    JudgedRun run = run_and_judge(diagram.get(), plan, run_options);
    if (work.job.is_cancelled()) return Json::object();
    auto stored = std::make_shared<StoredRun>();
    stored->path = path, stored->load = load, stored->held = held_signals(plan);
    stored->facts = facts_of(plan, run);
    stored->facts.update(
        {{"path", path}, {"command", command_of(folder_.path_of(path), options)}, {"set", set}});
    stored->signals = std::make_shared<Signals>(std::move(run.result.recording));
    Json answer = stored->facts;
    answer["signals"] = signals_json(*stored->signals, window_of(points, {}), stored->held);
    stored->facts["merit"] = merit_of(answer["signals"]);
    const int64_t number = results_.runs.add(stored);
    answer["run"] = number;
    return answer;
  });
}

std::shared_ptr<const Signals> Session::source_of_signals(const std::string& name) const {
  const size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon), rest = colon == name.npos ? "" : name.substr(colon + 1);
  const bool is_number =
      !rest.empty() && rest.size() < 10 && rest.find_first_not_of("0123456789") == rest.npos;
  if (kind == "run" && is_number) {
    const auto run = results_.runs.find(std::stoll(rest));
    if (run && run->signals) return run->signals;
    if (run) return signals_of_kept_run(folder_, run->kept_as);
  } else if (kind == "comparison" && is_number) {
    if (const auto comparison = results_.comparisons.find(std::stoll(rest))) return comparison->signals;
  } else if (kind == "record") {
    const std::string path = folder_.path_of(rest);
    const std::lock_guard lock(results_.record_mutex);
    std::error_code code;  // a file that is not there is told by its reader
    const auto written = std::filesystem::last_write_time(path, code).time_since_epoch().count();
    const std::string version =
        fmt::format("{} {} {}", path, written, std::filesystem::file_size(path, code));
    if (results_.record_version == version) return results_.record;
    Problems problems;
    const ColumnError error = [&](std::string message) -> Problem& {
      return problems.error({}, "", "", std::move(message));
    };
    Recording record = read_recording(path, problems, {.allow_not_finite = true, .allow_holes = true});
    if (problems.has_errors() || !put_time_first(record, error)) throw InputError(std::move(problems));
    results_.record_version = version, results_.record = std::make_shared<Signals>(std::move(record));
    return results_.record;
  }
  throw Refused(fmt::format("\"{}\" is not kept any more", name));
}

Json Session::signals(const Request& request) {
  const std::string name = request.required("source");
  const Window window{request.texts("names"), request.number("from", -INFINITY),
                      request.number("to", INFINITY), pixels(request.whole("points", 1200))};
  return start(request, [=, this](Work&) -> Json {
    std::set<std::string> held;
    if (name.starts_with("run:"))
      if (const auto run = results_.runs.find(std::atoll(name.c_str() + 4))) held = run->held;
    return {{"signals", signals_json(*source_of_signals(name), window, held)}};
  });
}

Json Session::export_view(const Request& request) {
  const std::string name = request.required("source"), target = request.required("to_file");
  if (target.ends_with(".json")) throw Refused("signals are written as .csv or .mat");
  if (!folder_.is_writable(target) || folder_.read(target))
    throw Refused(fmt::format("\"{}\" cannot be written, or is there already", target));
  const Window window{request.texts("names"), request.number("from", -INFINITY),
                      request.number("to", INFINITY)};
  const std::string path = folder_.path_of(target);
  return start(request, [=, this](Work&) -> Json {
    write_recording(path, cut(source_of_signals(name)->recording, window));
    return {{"path", target}};
  });
}

Json Session::runs(const Request& request) {
  const std::string path = request.text("path");
  std::map<int64_t, std::shared_ptr<const StoredRun>> listed;
  std::map<std::string, std::shared_ptr<const SourceFile>> files;
  for (const auto& [number, run] : results_.runs.all()) {
    if (!path.empty() && run->path != path) continue;
    listed[number] = run;
    try {
      if (!files.contains(run->path)) files[run->path] = source(run->path);
    } catch (const std::exception&) {  // the file is gone: nothing repeats its runs
      files[run->path] = nullptr;
    }
  }
  return start(request, [=](Work& work) -> Json {
    // A command repeats its run as long as the diagram that it loads is the same, files of subdiagrams
    // included.
    std::map<std::pair<std::string, std::string>, std::string> hashes;  // by file and by options as a command
    Json list = Json::array();
    for (const auto& [number, run] : listed) {
      if (work.job.is_cancelled()) break;
      const auto [hash, is_new] =
          hashes.try_emplace({run->path, run->facts["command"].get<std::string>()}, "");
      if (is_new) hash->second = present_hash(files.at(run->path), run->load);
      Json facts = run->facts;
      facts["run"] = number;
      facts["file_changed"] = hash->second != run->facts["hash"].get<std::string>();
      list.push_back(std::move(facts));
    }
    return {{"runs", std::move(list)}};
  });
}

Json Session::name_run(const Request& request) {
  const int64_t number = request.whole("run", 0);
  const auto run = results_.runs.find(number);
  if (!run) throw Refused(fmt::format("run {} is not kept any more", number));
  auto named = std::make_shared<StoredRun>(*run);
  named->facts["name"] = request.text("name"), named->facts["note"] = request.text("note");
  if (request.flag("keep")) {
    named->kept_as = keep_run(folder_, *named, run->kept_as);
  } else if (!run->kept_as.empty()) {
    named->signals = source_of_signals(fmt::format("run:{}", number));
    remove_kept_run(folder_, run->kept_as);
    named->kept_as.clear();
  }
  results_.runs.replace(number, named);
  return named->facts;
}

}  // namespace loopwright::studio
