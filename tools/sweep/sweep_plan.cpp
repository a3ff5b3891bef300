#include "tools/sweep/sweep_plan.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <set>
#include "engine/lanes/lane_run.h"
#include "engine/file/hash.h"
#include "tools/sweep/dependence.h"
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
  design_ = std::make_unique<SweepDesign>(*sweep_, changes_plan_);
  if (design_->worlds() > most_worlds) {
    const auto first = std::find(changes_plan_.begin(), changes_plan_.end(), true);
    const Axis& axis = sweep_->axes[size_t(first - changes_plan_.begin())];
    problems
        .error(axis.place, axis.pointer, "",
               fmt::format("variants and structural values need {} plans", design_->worlds()))
        .expected = fmt::format("at most {}", most_worlds);
    throw InputError(std::move(problems));
  }
  make_worlds(problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  ContentHash structure;
  std::vector<FileRead> files = {{sweep_->path, content_hash(sweep_->text)}};
  for (const World& world : worlds_) {
    const Identity& of_world = world.plan->identity;
    structure.add(of_world.structure);
    files.insert(files.end(), of_world.files.begin(), of_world.files.end());
  }
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

/// The first of some runs that the diagram accepts. Otherwise the problems of the first run are reported.
SweepPlan::Accepted SweepPlan::find_accepted(const Runs& runs, Problems& problems) const {
  Problems of_first, of_others;
  for (int i = 0; i <= Runs::examples; ++i) {
    const auto point = runs.example(i);
    if (auto plan = load_or_report(point, i == 0 ? of_first : of_others)) return {std::move(plan), point};
  }
  problems.add(of_first);
  return {};
}

/// A step of one axis to an end of its range. If the diagram refuses this end together with the other values
/// of `start`, those of other runs are tried: the end is wrong only if none of them fits.
SweepPlan::Step SweepPlan::find_step(const Runs& runs, const Accepted& start, size_t axis, double end,
                                     Problems& problems) const {
  const auto with = [axis](std::vector<double> point, double value) {
    point[axis] = value;
    return point;
  };
  Problems of_start, of_others;
  if (auto after = load_or_report(with(start.point, end), of_start))
    return {start.plan, std::move(after), start.point[axis]};
  bool is_wrong = true;
  for (int i = 0; i <= Runs::examples; ++i) {
    const auto point = runs.example(i);
    auto after = load_or_report(with(point, end), of_others);
    if (!after) continue;
    is_wrong = false;
    if (auto before = load_or_report(point, of_others))
      return {std::move(before), std::move(after), point[axis]};
  }
  if (is_wrong) problems.add(of_start);
  return {};
}

/// Examines each axis alone, at both ends of its range.
std::vector<bool> SweepPlan::find_axes_that_change_the_plan(Problems& problems) const {
  std::vector<bool> changes(sweep_->axes.size());
  const SweepDesign design(*sweep_, changes);
  const Runs runs{design, 0, design.runs()};
  const Accepted start = find_accepted(runs, problems);
  if (!start.plan) return changes;
  const auto [low, high] = design.range();
  for (size_t a = 0; a < changes.size(); ++a) {
    const Axis& axis = sweep_->axes[a];
    if (axis.kind == Axis::Kind::variants) {
      changes[a] = true;
      continue;
    }
    for (const double end : {low[a], high[a]})
      if (const Step step = find_step(runs, start, a, end, problems); step.after)
        changes[a] = changes[a] || skeleton(*step.after) != skeleton(*step.before);
    if (!changes[a] || !axis.is_sampled()) continue;
    auto& p =
        problems.error(axis.place, axis.pointer, "",
                       fmt::format("\"{}\" is structural: each value needs a plan of its own", axis.name));
    p.expected = "\"values\", \"linear\" or \"logarithmic\"";
  }
  return changes;
}

SweepPlan::Runs SweepPlan::runs_of(int64_t world) const {
  return {*design_, world * design_->runs_in_world(), design_->runs_in_world()};
}

/// If the diagram refuses every run of a world, but accepts its variants in another one, the combination is
/// at fault: its runs are made alone, and fail.
void SweepPlan::make_worlds(Problems& problems) {
  const auto variants_of = [this](size_t world) {
    auto point = design_->point(int64_t(world) * design_->runs_in_world());
    for (size_t a = 0; a < point.size(); ++a)
      if (sweep_->axes[a].kind != Axis::Kind::variants) point[a] = 0;
    return point;
  };
  std::vector<Problems> refused(size_t(design_->worlds()));
  for (size_t w = 0; w < refused.size() && !problems.has_errors(); ++w)
    worlds_.push_back(make_world(int64_t(w), problems, refused[w]));
  std::map<std::vector<double>, size_t> accepted;
  for (size_t w = 0; w < worlds_.size(); ++w)
    if (worlds_[w].plan) accepted.try_emplace(variants_of(w), w);
  for (size_t w = 0; w < worlds_.size(); ++w) {
    if (worlds_[w].plan) continue;
    if (const auto other = accepted.find(variants_of(w)); other != accepted.end()) {
      worlds_[w].plan = worlds_[other->second].plan, worlds_[w].observed = worlds_[other->second].observed;
      worlds_[w].lanes_forbidden = "the diagram refuses its parameters";
    } else {
      problems.add(refused[w]);
    }
  }
}

World SweepPlan::make_world(int64_t index, Problems& problems, Problems& refused) const {
  World world;
  const Accepted start = find_accepted(runs_of(index), refused);
  world.plan = start.plan;
  if (!world.plan) return world;
  world.observed = observe(*sweep_, *world.plan, problems);
  world.lanes_forbidden = lanes_forbidden_by(*world.plan);
  if (!problems.has_errors() && world.lanes_forbidden.empty()) bind(world, runs_of(index), start, problems);
  return world;
}

/// Adds the numbers that follow from an axis through an expression: they are computed for each run. False if
/// some of them belong to the structure; each run then needs a plan of its own.
bool SweepPlan::add_computed(World& world, const Accepted& start,
                             std::map<std::string, World::Source>& found) const {
  const auto numbers = tunable_numbers(*world.plan);
  std::vector<std::string> parameters;
  for (size_t a = 0; a < sweep_->axes.size(); ++a)
    if (!changes_plan_[a] && !numbers.contains(sweep_->axes[a].name))
      parameters.push_back(sweep_->axes[a].name);
  if (parameters.empty()) return true;
  Problems unheard;  // the plan was made of the same diagram
  const std::lock_guard lock(loading_);
  const auto diagram = load_diagram(sweep_->diagram, options_at(start.point), unheard);
  for (const std::string& path : computed_settings(*diagram, parameters)) {
    if (numbers.contains(path)) {
      found[path] = {};
      continue;
    }
    world.lanes_forbidden = fmt::format("\"{}\" is structural and follows from an axis", path);
    return false;
  }
  return true;
}

/// Whether two numbers of one block differ between runs, so that the block must check them together.
static bool is_shared_by_one_block(const std::vector<std::string>& tuned, const Plan& plan) {
  return std::ranges::any_of(plan.blocks, [&](const Plan::Block& block) {
    return std::ranges::count_if(
               tuned, [&](const std::string& path) { return path.starts_with(block.path + "."); }) > 1;
  });
}

/// Determines which tunable numbers depend on each axis, and how. The rule found at the ends of the axes is
/// then checked at runs in between; if it fails, every number comes from the loader.
void SweepPlan::bind(World& world, const Runs& runs, const Accepted& start, Problems& problems) const {
  const auto base = tunable_numbers(*world.plan);
  const auto [low, high] = design_->range();
  std::map<std::string, World::Source> found;
  for (size_t a = 0; a < sweep_->axes.size(); ++a) {
    const Axis& axis = sweep_->axes[a];
    if (changes_plan_[a]) continue;
    const auto unit = parse_unit(axis.unit);
    const double scale = unit && !axis.unit.empty() ? unit->scale : 1.0;
    for (const double end : {low[a], high[a]}) {
      const Step step = find_step(runs, start, a, end, problems);
      if (!step.after) continue;
      const auto numbers = tunable_numbers(*step.before);
      for (const auto& [path, number] : tunable_numbers(*step.after)) {
        const auto before = numbers.find(path);
        if (before == numbers.end() || before->second == number) continue;
        const bool is_direct = number == end * scale && before->second == step.from * scale;
        const auto [entry, is_new] = found.try_emplace(path, World::Source{is_direct ? int(a) : -1, scale});
        if (!is_new && (entry->second.axis != int(a) || !is_direct)) entry->second.axis = -1;
      }
    }
  }
  if (problems.has_errors() || !add_computed(world, start, found)) return;
  const auto take = [&] {
    world.tuned.clear(), world.sources.clear();
    for (const auto& [path, source] : found) {
      world.tuned.push_back(path), world.sources.push_back(source);
      world.needs_loader |= source.axis < 0;
    }
    world.needs_loader |= is_shared_by_one_block(world.tuned, *world.plan);
  };
  take();
  for (int i = 1; i <= joint_checks; ++i)
    if (!predicts(world, runs.first + (runs.count - 1) * i / joint_checks)) {
      for (const auto& [path, number] : base) found[path] = {};
      return take();
    }
}

/// Whether the sources give every tunable number of a run as the loader does.
bool SweepPlan::predicts(const World& world, int64_t run) const {
  Problems of_run;
  const auto plan = load_or_report(design_->point(run), of_run);
  if (!plan) return true;  // a failure of that run
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
