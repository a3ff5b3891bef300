#include "tools/sweep/sweep_plan.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <set>
#include "engine/lanes/lane_run.h"
#include "engine/file/hash.h"
#include "tools/sweep/tunables.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

constexpr int64_t most_worlds = 1000;
constexpr int joint_checks = 6;

/// A number as `--set` accepts it, read back bit for bit.
std::string setting(const Axis& axis, double value) {
  return axis.unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, axis.unit);
}

std::string quoted(const std::string& text) {
  std::string in_quotes = "'";
  for (const char c : text) in_quotes += c == '\'' ? "'\\''" : std::string(1, c);
  return in_quotes + "'";
}

/// Problems with the value set by an axis refer to the axis.
void add_at_axes(const Problems& found, const Sweep& sweep, Problems& problems) {
  for (Problem problem : found.list()) {
    if (problem.severity != Problem::Severity::error) continue;
    for (const Axis& axis : sweep.axes)
      if (problem.place.file && problem.place.file->name == "--set " + axis.name) {
        problem.place = axis.place, problem.pointer = axis.pointer;
        problem.found += (problem.found.empty() ? "" : ": ") + std::string("set by this axis");
      }
    const auto same = [&](const Problem& told) {
      return told.message == problem.message && told.place.offset == problem.place.offset &&
             told.block == problem.block;
    };
    if (std::none_of(problems.list().begin(), problems.list().end(), same)) problems.add(problem);
  }
}

}  // namespace

SweepPlan::SweepPlan(std::shared_ptr<const Sweep> sweep) : sweep_(std::move(sweep)) {
  Problems problems;
  changes_plan_ = find_axes_that_change_the_plan(problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  design_ = std::make_unique<Design>(*sweep_, changes_plan_);
  if (design_->worlds() > most_worlds) {
    const auto first = std::find(changes_plan_.begin(), changes_plan_.end(), true);
    const Axis& axis = sweep_->axes[size_t(first - changes_plan_.begin())];
    problems
        .error(axis.place, axis.pointer, "",
               fmt::format("variants and structural values need {} plans", design_->worlds()))
        .expected = fmt::format("at most {}", most_worlds);
    throw InputError(std::move(problems));
  }
  ContentHash structure;
  std::vector<FileRead> files = {{sweep_->path, content_hash(sweep_->text)}};
  for (int64_t w = 0; w < design_->worlds() && !problems.has_errors(); ++w) {
    worlds_.push_back(make_world(w, problems));
    if (!worlds_.back().plan) continue;
    const Identity& of_world = worlds_.back().plan->identity;
    structure.add(of_world.structure);
    files.insert(files.end(), of_world.files.begin(), of_world.files.end());
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  // Files of the worlds are already named relative to the diagram's folder, the sweep file by its own name.
  files.front().path = std::filesystem::path(sweep_->path).filename().string();
  identity_ = {structure.text(), program_build(), named_from("", std::move(files))};
  hash_ = identity_.hash();
}

LoadOptions SweepPlan::options_at(const std::vector<double>& point) const {
  LoadOptions options = sweep_->options;
  for (size_t a = 0; a < sweep_->axes.size(); ++a) {
    const Axis& axis = sweep_->axes[a];
    if (axis.kind == Axis::Kind::variants)
      options.variants[axis.name] = axis.variants[whole_index(point[a], axis.variants.size())];
    else
      options.set.emplace_back(axis.name, setting(axis, point[a]));
  }
  return options;
}

std::string SweepPlan::command(const LoadOptions& with, int64_t run) const {
  std::string text = fmt::format("loopwright run {}", quoted(sweep_->diagram));
  for (const auto& [block, variant] : with.variants)
    text += fmt::format(" --variant {}", quoted(block + "=" + variant));
  for (const auto& [path, value] : with.set) text += fmt::format(" --set {}", quoted(path + "=" + value));
  return text + fmt::format(" --run {}", run);
}

std::shared_ptr<const Plan> SweepPlan::load(const LoadOptions& options) const {
  const std::lock_guard lock(loading_);
  return load_plan(sweep_->diagram, options);
}

std::shared_ptr<const Plan> SweepPlan::load_or_report(const std::vector<double>& point,
                                                      Problems& problems) const {
  try {
    return load(options_at(point));
  } catch (const InputError& error) {
    add_at_axes(error.problems, *sweep_, problems);
    return nullptr;
  }
}

/// Examines each axis alone, at both ends of its range.
std::vector<bool> SweepPlan::find_axes_that_change_the_plan(Problems& problems) const {
  std::vector<bool> changes(sweep_->axes.size());
  const Design design(*sweep_, changes);
  const auto start = design.point(0);
  const auto base = load_or_report(start, problems);
  if (!base) return changes;
  const std::string unchanged = skeleton(*base);
  const auto [low, high] = design.range();
  for (size_t a = 0; a < changes.size(); ++a) {
    const Axis& axis = sweep_->axes[a];
    if (axis.kind == Axis::Kind::variants) {
      changes[a] = true;
      continue;
    }
    for (const double end : {low[a], high[a]}) {
      auto point = start;
      point[a] = end;
      if (const auto plan = load_or_report(point, problems))
        changes[a] = changes[a] || skeleton(*plan) != unchanged;
    }
    if (!changes[a] || !axis.is_sampled()) continue;
    auto& p =
        problems.error(axis.place, axis.pointer, "",
                       fmt::format("\"{}\" is structural: each value needs a plan of its own", axis.name));
    p.expected = "\"values\", \"linear\" or \"logarithmic\"";
  }
  return changes;
}

World SweepPlan::make_world(int64_t index, Problems& problems) {
  World world;
  world.plan = load_or_report(design_->point(index * design_->runs_in_world()), problems);
  if (!world.plan) return world;
  world.observed = observe(*sweep_, *world.plan, problems);
  world.lanes_forbidden = lanes_forbidden_by(*world.plan);
  if (!problems.has_errors() && world.lanes_forbidden.empty()) bind(world, index, problems);
  return world;
}

/// Determines which tunable numbers depend on each axis, and how. The rule found at the ends of the axes is
/// then checked at runs in between; if it fails, every number comes from the loader.
void SweepPlan::bind(World& world, int64_t index, Problems& problems) {
  const int64_t first = index * design_->runs_in_world(), count = design_->runs_in_world();
  const auto start = design_->point(first);
  const auto base = tunable_numbers(*world.plan);
  const auto [low, high] = design_->range();
  std::map<std::string, World::Source> found;
  for (size_t a = 0; a < sweep_->axes.size(); ++a) {
    const Axis& axis = sweep_->axes[a];
    if (changes_plan_[a]) continue;
    const auto unit = parse_unit(axis.unit);
    const double scale = unit && !axis.unit.empty() ? unit->scale : 1.0;
    for (const double end : {low[a], high[a]}) {
      auto point = start;
      point[a] = end;
      const auto plan = load_or_report(point, problems);
      if (!plan) return;
      for (const auto& [path, number] : tunable_numbers(*plan)) {
        const auto before = base.find(path);
        if (before == base.end() || before->second == number) continue;
        const bool is_direct = number == end * scale && before->second == start[a] * scale;
        const auto [entry, is_new] = found.try_emplace(path, World::Source{is_direct ? int(a) : -1, scale});
        if (!is_new && (entry->second.axis != int(a) || !is_direct)) entry->second.axis = -1;
      }
    }
  }
  const auto take = [&] {
    world.tuned.clear(), world.sources.clear();
    world.needs_loader = false;
    for (const auto& [path, source] : found) {
      world.tuned.push_back(path), world.sources.push_back(source);
      world.needs_loader |= source.axis < 0;
    }
  };
  take();
  for (int i = 1; i <= joint_checks; ++i)
    if (!predicts(world, first + (count - 1) * i / joint_checks, problems)) {
      for (const auto& [path, number] : base) found[path] = {};
      return take();
    }
}

/// Whether the sources give every tunable number of a run as the loader does.
bool SweepPlan::predicts(const World& world, int64_t run, Problems& problems) const {
  const auto plan = load_or_report(design_->point(run), problems);
  if (!plan) return true;  // reported
  auto expected = tunable_numbers(*world.plan);
  const auto point = design_->point(run);
  const auto actual = tunable_numbers(*plan);
  for (size_t i = 0; i < world.tuned.size(); ++i) {
    const World::Source& source = world.sources[i];
    expected[world.tuned[i]] =
        source.axis < 0 ? actual.at(world.tuned[i]) : point[size_t(source.axis)] * source.scale;
  }
  return expected == actual;
}

std::vector<double> SweepPlan::tuned(int64_t run) const {
  const World& world = world_of(run);
  std::vector<double> numbers(world.tuned.size());
  const auto point = design_->point(run);
  std::map<std::string, double> loaded;
  if (world.needs_loader) loaded = tunable_numbers(*plan_of(run));
  for (size_t i = 0; i < numbers.size(); ++i) {
    const World::Source& source = world.sources[i];
    numbers[i] = source.axis < 0 ? loaded.at(world.tuned[i]) : point[size_t(source.axis)] * source.scale;
  }
  return numbers;
}

}  // namespace loopwright
