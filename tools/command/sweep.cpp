#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <thread>
#include "engine/file/output_files.h"
#include "engine/record/atomic_file.h"
#include "engine/record/recording_file.h"
#include "engine/run/simulation.h"
#include "tools/command/command.h"
#include "tools/sweep/optimise.h"
#include "tools/sweep/ranks.h"
#include "tools/sweep/run_sweep.h"
#include "tools/run/judged_run.h"
#include "tools/run/run_page.h"
#include "tools/sweep/sweep_page.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

struct SweepArguments {
  std::string file, folder, shard, instruction_set, minimise, maximise;
  DiagramArguments libraries;
  int threads = int(std::max(1u, std::thread::hardware_concurrency())), evaluations = 300;
  bool resume = false;
};

[[noreturn]] void refuse(std::string message, std::string expected) {
  Problems problems;
  problems.error({}, "", "", std::move(message)).expected = std::move(expected);
  throw InputError(std::move(problems));
}

std::pair<int64_t, int64_t> shard_of(const std::string& text) {
  if (text.empty()) return {0, 1};
  int64_t i = -1, n = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, i);
  const auto second = first.ptr == end ? first : std::from_chars(first.ptr + 1, end, n);
  const bool is_read = first.ec == std::errc() && second.ec == std::errc() && first.ptr != end;
  if (!is_read || *first.ptr != '/' || second.ptr != end || i < 0 || i >= n)
    refuse(fmt::format("--shard {}", text), "i/n with 0 ≤ i < n, as in 3/16");
  return {i, n};
}

std::optional<InstructionSet> set_of(const std::string& name) {
  if (name.empty()) return {};
  for (const InstructionSet set : all_instruction_sets) {
    if (to_name(set) != name) continue;
    if (const std::string reason = lanes_unavailable(set); !reason.empty())
      refuse(fmt::format("--lanes {}: {}", name, reason), "a set that this machine has");
    return set;
  }
  refuse(fmt::format("--lanes {}", name), "scalar, avx2 or avx512");
}

SweepPlan plan_of(const std::string& file) {
  Problems problems;
  auto sweep = load_sweep(file, problems);
  if (!sweep) throw InputError(std::move(problems));
  return SweepPlan(std::move(sweep));
}

constexpr size_t most_trace_pages = 20;  // more pages would be too large and would not be read

std::string trace_of(const std::string& folder, int64_t run, const char* ending) {
  return fmt::format("{}/traces/run_{}.{}", folder, run, ending);
}

/// The full recordings of the runs that the sweep file keeps, each simulated once more by itself, and pages
/// of the first ones.
void write_traces(const SweepPlan& plan, const std::string& folder, const SweepResults& results) {
  const auto runs = runs_to_keep(plan, results);
  if (runs.empty()) return;
  std::filesystem::create_directories(folder + "/traces");
  for (size_t i = 0; i < runs.size(); ++i) {
    if (interruption()) return;
    RunOptions options;
    options.run = runs[i];
    const auto run = plan.plan_of(runs[i]);
    const auto [result, figures] = run_and_judge(nullptr, *run, options);
    write_recording(trace_of(folder, runs[i], "csv"), result.recording);
    if (i < most_trace_pages)
      report::write_html(trace_of(folder, runs[i], "html"), run_page(nullptr, *run, result, figures));
  }
  remark("{} traces in {}/traces\n", runs.size(), folder);
}

/// The sweep reads none of the tables that it writes.
void reserve_tables(const std::string& folder) {
  for (const char* name : {"results.csv", "results.mat", "failures.txt"})
    reserve_for_output(folder + '/' + name, "--output");
}

/// Returns the number of runs missing in the tables.
int64_t write_tables(const SweepPlan& plan, const std::string& folder) {
  const SweepResults results = read_results(plan, folder);
  for (const std::string& note : results.notes) tell("warning: {}\n", note);
  write_recording(folder + "/results.csv", results.table);
  write_recording(folder + "/results.mat", results.table);
  std::string failures;
  for (const auto& [run, reason] : results.failures) failures += fmt::format("run {}: {}\n", run, reason);
  write_file(folder + "/failures.txt", failures);
  remark("{} runs in {}/results.csv and .mat; {} failed{}\n", results.table.rows(), folder,
         results.failures.size(), results.missing ? fmt::format("; {} are missing", results.missing) : "");
  if (results.missing == 0) write_traces(plan, folder, results);
  return results.missing;
}

int optimise(const SweepPlan& plan, const SweepArguments& a) {
  Progress progress("sweep");
  OptimiseOptions options;
  options.maximise = !a.maximise.empty();
  options.metric = options.maximise ? a.maximise : a.minimise;
  options.evaluations = a.evaluations;
  options.interrupt = &interruption();
  options.progress = [&](int runs, int total) { progress.show(runs, total); };
  const Optimum best = optimise(plan, options);
  progress.finish();
  if (!best.found) {
    tell("none of {} runs has the metric\n", best.evaluations);
    return best.interrupted ? interrupted : run_failed;
  }
  const auto& metrics = plan.sweep().metrics;
  const auto metric =
      std::find_if(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.name == options.metric; });
  answer("{} {} = {} {}\n", options.maximise ? "greatest" : "least", options.metric, best.value,
         plan.world(0).observed.units[size_t(metric - metrics.begin())]);
  for (size_t i = 0; i < best.point.size(); ++i) {
    const Axis& axis = plan.sweep().axes[i];
    answer("  {} = {}\n", axis.name,
           axis.kind == Axis::Kind::variants ? axis.variants[whole_index(best.point[i], axis.variants.size())]
                                             : fmt::format("{} {}", best.point[i], axis.unit));
  }
  answer("{}\n", plan.command(plan.options_at(best.point), 0));
  answer("{} runs, {} of them failed\n", best.evaluations, best.failed);
  return best.interrupted ? interrupted : done;
}

int make(const SweepPlan& plan, const SweepArguments& a, std::pair<int64_t, int64_t> shard) {
  if (a.folder.empty()) refuse("no folder for the results", "-o DIR");
  Ranks ranks;
  SweepOptions options;
  options.threads = a.threads, options.resume = a.resume;
  options.instruction_set = set_of(a.instruction_set);
  std::tie(options.shard, options.shards) = shard;
  ranks.join(options);
  options.interrupt = &interruption();
  Progress progress("sweep");
  if (ranks.is_first())
    options.progress = [&](int64_t runs, int64_t total) { progress.show(double(runs), double(total)); };
  const SweepOutcome outcome = run_sweep(plan, a.folder, options);
  ranks.wait();
  progress.finish();
  for (const std::string& note : outcome.notes) tell("{}\n", note);
  remark("{}{} of {} runs done, {} now, {} of them failed\n", ranks.name(), outcome.done, outcome.runs,
         outcome.made, outcome.failed);
  if (options.shards == 1 && ranks.is_first()) write_tables(plan, a.folder);
  if (!outcome.interrupted) return done;
  tell("interrupted; --resume goes on\n");
  return interrupted;
}

int run(const SweepArguments& a) {
  const auto shard = shard_of(a.shard);
  if (!a.folder.empty()) reserve_tables(a.folder);
  a.libraries.options();
  const SweepPlan plan = plan_of(a.file);
  return a.minimise.empty() && a.maximise.empty() ? make(plan, a, shard) : optimise(plan, a);
}

int write_report(const std::string& folder, const std::string& page) {
  const SweepPlan plan = plan_of(sweep_file_of(folder));
  const std::string path = page.empty() ? folder + "/report.html" : page;
  require_writable_file(path, "-o");
  const SweepResults results = read_results(plan, folder);
  const auto home = std::filesystem::absolute(path).parent_path();
  TracePages traces;
  for (const int64_t run : runs_to_keep(plan, results))
    if (const std::string trace = trace_of(folder, run, "html"); std::filesystem::exists(trace))
      traces[run] = std::filesystem::absolute(trace).lexically_relative(home);
  report::write_html(path, sweep_page(plan, results, traces));
  remark("{}\n", path);
  return done;
}

}  // namespace

void add_sweep(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("sweep", "Run a diagram many times, each with other parameters");
  auto a = std::make_shared<SweepArguments>();
  command->add_option("sweep", a->file, "Sweep file (JSON)");
  command->add_option("-o,--output", a->folder, "Folder for the results");
  command->add_option("-j,--threads", a->threads, "Threads")->check(CLI::Range(1, 1024));
  command->add_flag("--resume", a->resume, "Go on with the results in the folder");
  command->add_option("--shard", a->shard, "This part of so many, i/n: for arrays of jobs");
  command->add_option("--lanes", a->instruction_set,
                      "scalar, avx2 or avx512; the widest there is when left out");
  command->add_option("--blocks", a->libraries.libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  auto* least =
      command->add_option("--minimize", a->minimise, "Look for the point at which this metric is least");
  command->add_option("--maximize", a->maximise, "… or greatest: the worst case")->excludes(least);
  command->add_option("--evaluations", a->evaluations, "Runs of such a search")
      ->check(CLI::Range(1, 1'000'000));
  command->callback([=] {
    if (!command->get_subcommands().empty()) return;
    if (a->file.empty()) throw CLI::RequiredError("sweep");
    choose([=] { return run(*a); });
  });
  auto folder = std::make_shared<std::string>(), page = std::make_shared<std::string>();
  CLI::App* merged = command->add_subcommand("merge", "Tables from all results in a folder");
  merged->add_option("folder", *folder, "Folder of a sweep")->required();
  merged->callback([=] {
    choose([=] {
      reserve_tables(*folder);
      a->libraries.options();
      return write_tables(plan_of(sweep_file_of(*folder)), *folder) == 0 ? done : run_failed;
    });
  });
  CLI::App* shown = command->add_subcommand("report", "A page on the results in a folder");
  shown->add_option("folder", *folder, "Folder of a sweep")->required();
  shown->add_option("-o,--output", *page, "The page; report.html in the folder when left out");
  shown->callback([=] {
    choose([=] {
      a->libraries.options();
      return write_report(*folder, *page);
    });
  });
}

}  // namespace loopwright
