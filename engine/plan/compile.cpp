#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include "engine/plan/gates.h"
#include "engine/plan/layout.h"
#include "engine/plan/load.h"
#include "engine/plan/order.h"
#include "engine/plan/shapes.h"
#include "engine/plan/signal_rates.h"
#include "engine/plan/times.h"
#include "engine/plan/units.h"
#include "engine/file/hash.h"
#include "engine/file/regular_file.h"

namespace loopwright {
namespace {

/// The default recording of a diagram without "log": all outputs of its blocks. Of a subdiagram it has the
/// declared outputs, or if there are none, the outputs of its blocks by the same rule.
class LogOfEverything {
 public:
  explicit LogOfEverything(FlatDiagram& flat) : flat_(flat) {
    for (const FlatName& name : flat.names) names_.emplace(name.name, &name.wire);
  }

  void add(const Diagram& diagram, const std::string& prefix = "", bool is_shown = true) {
    for (const BlockEntry& entry : diagram.blocks) {
      if (entry.subdiagram)
        add_subdiagram(*entry.subdiagram, prefix + entry.name + ".", is_shown);
      else if (next_ < flat_.blocks.size() && flat_.blocks[next_].entry == &entry)
        add_block(next_++, is_shown);
    }
  }

 private:
  void add_subdiagram(const Diagram& diagram, const std::string& prefix, bool is_shown) {
    if (is_shown)
      for (const DiagramOutput& output : diagram.outputs)
        if (const auto found = names_.find(prefix + output.name); found != names_.end())
          flat_.log.push_back({found->first, *found->second});
    add(diagram, prefix, is_shown && diagram.outputs.empty());
  }
  void add_block(size_t index, bool is_shown) {
    if (!is_shown) return;
    const FlatBlock& block = flat_.blocks[index];
    for (size_t o = 0; o < block.type->info.outputs.size(); ++o) {
      FlatWire wire;
      wire.block = int(index), wire.output = int(o);
      flat_.log.push_back({fmt::format("{}.{}", block.path, block.type->info.outputs[o].name), wire});
    }
  }

  FlatDiagram& flat_;
  std::unordered_map<std::string, const FlatWire*> names_;
  size_t next_ = 0;  // flat blocks are in the order of the diagrams
};

void add_log(const FlatDiagram& flat, const Layout& layout, const PortUnits& units, Plan& plan,
             Problems& problems) {
  std::vector<std::string> names;
  std::vector<Number> numbers;
  for (const FlatLog& log : flat.log) {
    if (!log.wire.is_resolved()) continue;
    numbers.clear();
    layout.append_numbers(log.wire, numbers);
    const auto& unit = units.of(log.wire.block, log.wire.output);
    for (size_t i = 0; i < numbers.size(); ++i) {
      Plan::Logged logged;
      logged.name = numbers.size() == 1 ? log.name : fmt::format("{}[{}]", log.name, i);
      logged.unit = unit.value_or(Unit{});
      logged.unit_is_known = unit.has_value();
      logged.number = numbers[i];
      names.push_back(logged.name);
      plan.log.push_back(std::move(logged));
    }
  }
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice != names.end())
    problems.error(flat.log.front().wire.at ? flat.log.front().wire.at->place : Place{}, "/log", "",
                   fmt::format("\"{}\" is logged twice", *twice));
}

void add_rates_to_log(Plan& plan) {
  const std::vector<Rate> rates = rates_of_signals(plan);
  for (Plan::Logged& logged : plan.log) logged.rate = rates[size_t(logged.number)];
}

/// The source of each number, and its unit.
void add_sources(const PortUnits& units, const std::vector<int>& flat_of_block, Plan& plan,
                 Plan::Lists& lists) {
  lists.output_units.reserve(lists.outputs.size());  // blocks point into it, so it must not reallocate
  plan.sources.assign(size_t(plan.signals + plan.states), {-1, -1});
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    Plan::Block& block = plan.blocks[b];
    for (size_t o = 0; o < block.outputs.size(); ++o) {
      const int length =
          block.type->info.outputs[o].shape == PortInfo::Shape::vector ? block.output_lengths[o] : 1;
      for (int i = 0; i < length; ++i) plan.sources[size_t(block.outputs[o] + i)] = {int(b), int(o)};
      lists.output_units.push_back(flat_of_block[b] < 0 ? std::nullopt : units.of(flat_of_block[b], int(o)));
    }
    block.output_units = std::span(lists.output_units).last(block.outputs.size());
  }
}

/// Every port by path, sorted by name. Names and numbers are collected contiguously and sorted there, as
/// comparing and building them across scattered memory becomes slow for many ports.
class PortList {
 public:
  explicit PortList(const Layout& layout) : layout_(layout) {}

  void add(std::string_view path, std::string_view dot, std::string_view port, const FlatWire& wire) {
    const size_t first = numbers_.size();
    layout_.append_numbers(wire, numbers_);
    ports_.push_back({text_.size(), path.size() + dot.size() + port.size(), first, numbers_.size() - first});
    text_.append(path).append(dot).append(port);
  }
  /// The ports added since the last end are neighbors in the order of names. Their names share this many
  /// characters at the beginning, which determine the position of the group among the others.
  void end_group(size_t same_letters) {
    const size_t first = groups_.empty() ? 0 : groups_.back().end;
    if (first == ports_.size()) return;
    std::stable_sort(ports_.begin() + ptrdiff_t(first), ports_.end(),
                     [this](const Port& a, const Port& b) { return name(a) < name(b); });
    groups_.push_back({first, ports_.size(), ports_[first].name, same_letters});
  }
  std::vector<Plan::Port> sorted(Plan::Lists& lists) {
    std::ranges::stable_sort(groups_, {}, [this](const Group& group) {
      return std::string_view(text_).substr(group.name, group.same_letters);
    });
    lists.port_names = std::move(text_), lists.port_numbers = std::move(numbers_);
    const std::string_view names = lists.port_names;
    const std::span<const Number> numbers = lists.port_numbers;
    std::vector<Plan::Port> list;
    list.reserve(ports_.size());
    for (const Group& group : groups_)
      for (size_t p = group.first; p < group.end; ++p)
        list.push_back({names.substr(ports_[p].name, ports_[p].name_length),
                        numbers.subspan(ports_[p].first_number, ports_[p].numbers)});
    return list;
  }

 private:
  struct Port {
    size_t name, name_length;  // in the text
    size_t first_number, numbers;
  };
  struct Group {
    size_t first, end;          // of the ports
    size_t name, same_letters;  // in the text
  };
  std::string_view name(const Port& port) const {
    return std::string_view(text_).substr(port.name, port.name_length);
  }

  const Layout& layout_;
  std::string text_;
  std::vector<Number> numbers_;
  std::vector<Port> ports_;
  std::vector<Group> groups_;
};

/// Outputs and inputs of blocks and subdiagrams by full path.
void add_ports(const FlatDiagram& flat, const Layout& layout, Plan& plan, Plan::Lists& lists) {
  PortList list(layout);
  for (size_t b = 0; b < flat.blocks.size(); ++b) {
    const FlatBlock& block = flat.blocks[b];
    const BlockInfo& info = block.type->info;
    FlatWire own;
    own.block = int(b);
    for (own.output = 0; own.output < int(info.outputs.size()); ++own.output)
      list.add(block.path, ".", info.outputs[size_t(own.output)].name, own);
    for (size_t i = 0; i < info.inputs.size(); ++i)
      if (block.inputs[i].size() == 1 && block.inputs[i][0].is_resolved())
        list.add(block.path, ".", info.inputs[i].name, block.inputs[i][0]);
    list.end_group(block.path.size() + 1);
  }
  for (const FlatName& name : flat.names)
    if (name.wire.is_resolved()) {
      list.add(name.name, "", "", name.wire);
      list.end_group(name.name.size());
    }
  plan.ports = list.sorted(lists);
}

void add_crossings(Plan& plan) {
  std::vector<bool> is_continuous(plan.blocks.size(), false);
  for (const Plan::Entry& entry : plan.order)
    if (entry.kind != Plan::Entry::Kind::algebraic_loop && entry.rate.kind == Rate::Kind::continuous)
      is_continuous[size_t(entry.block)] = true;
  int next = 0;
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    Plan::Block& block = plan.blocks[b];
    const bool may_cross = block.type->kernels.crossings &&
                           (!block.type->info.may_cross || block.type->info.may_cross(block.value.get()));
    const bool watched = may_cross && block.period == 0 && (is_continuous[b] || block.states > 0);
    block.first_crossing = watched ? next : -1;
    if (!watched) continue;
    for (const CrossingInfo& crossing : block.type->info.crossings)
      plan.crossings.push_back({int(b), crossing.name, crossing.direction});
    next += int(block.type->info.crossings.size());
  }
}

std::string hash_of_structure(const Plan& plan) {
  ContentHash hash;
  const auto add = [&](const auto& number) {
    hash.add({reinterpret_cast<const char*>(&number), sizeof number});
  };
  for (const Plan::Block& block : plan.blocks) {
    hash.add(block.path).add("\n").add(block.type->info.type).add("\n");
    for (const auto& port : block.inputs)
      for (Number n : port) add(n);
    add(block.period), add(block.offset), add(block.first_state);
    if (block.gate >= 0) add(plan.gates[size_t(block.gate)].on);
  }
  for (const Plan::Gate& gate : plan.gates)
    for (const int block : gate.restarts) add(block);
  for (const auto& [name, value] : plan.parameters) hash.add(name).add("=").add(value).add("\n");
  for (const Plan::Logged& logged : plan.log) hash.add(logged.name), add(logged.number);
  for (int64_t n : {plan.clock.base.numerator, plan.clock.base.denominator, plan.start_tick, plan.stop_tick,
                    plan.step_ticks, plan.record_ticks, int64_t(plan.method), int64_t(plan.seed)})
    add(n);
  for (double x : {plan.relative_tolerance, plan.absolute_tolerance, plan.maximum_step}) add(x);
  return hash.text();
}

/// Files that a block named but read by itself are read again for their contents.
std::vector<FileRead> with_contents(std::vector<FileRead> files) {
  std::set<std::string> known;
  for (const FileRead& file : files)
    if (!file.hash.empty()) known.insert(file.path);
  std::erase_if(files, [&](const FileRead& file) { return file.hash.empty() && known.contains(file.path); });
  for (FileRead& file : files) {
    std::string bytes;
    if (!file.hash.empty()) continue;
    const std::string reason = read_regular_file(file.path, std::numeric_limits<uint32_t>::max(), bytes);
    file.hash = content_hash(reason.empty() ? bytes : reason);
  }
  return files;
}

/// `first_file`: the files that `problems` had before belong to something else.
Identity identity_of(const Plan& plan, const Diagram& diagram, const Problems& problems, size_t first_file) {
  std::vector<FileRead> files = diagram.files_read;
  files.insert(files.end(), problems.files().begin() + ptrdiff_t(first_file), problems.files().end());
  files = named_from(diagram.path, with_contents(std::move(files)));
  std::set<const FileRead*> libraries;  // by their own names: they do not move with the diagram
  for (const Plan::Block& block : plan.blocks)
    if (const FileRead* library = block.type->library; library && libraries.insert(library).second)
      files.push_back({std::filesystem::path(library->path).filename().string(), library->hash});
  std::ranges::sort(files, {}, [](const FileRead& file) { return std::tie(file.path, file.hash); });
  return {hash_of_structure(plan), program_build(), std::move(files)};
}

}  // namespace

std::shared_ptr<const Plan> compile(const Diagram& diagram, Problems& problems) {
  const size_t first_file = problems.files().size();
  FlatDiagram flat = flatten(diagram, problems);
  if (flat.log.empty() && diagram.log.empty()) LogOfEverything(flat).add(diagram);
  find_shapes(flat, problems);
  const PortUnits units = check_units(flat, diagram, problems);
  auto plan = std::make_shared<Plan>();
  plan->title = diagram.title;
  plan->solver_place = diagram.solver.place;
  if (problems.has_errors()) {  // the times are still checked
    find_times(diagram, flat, {}, *plan, problems);
    return nullptr;
  }
  const auto lists = std::make_shared<Plan::Lists>();
  plan->lists = lists;
  lists->instance_types = flat.instance_types;
  const Layout layout(flat, *plan, *lists);
  std::vector<int> flat_of_block;
  for (size_t f = 0; f < flat.blocks.size(); ++f)
    flat_of_block.insert(flat_of_block.end(), size_t(flat.blocks[f].width), int(f));
  flat_of_block.resize(plan->blocks.size(), -1);
  find_times(diagram, flat, flat_of_block, *plan, problems);
  add_gates(flat, flat_of_block, *plan, problems);
  add_sources(units, flat_of_block, *plan, *lists);
  add_log(flat, layout, units, *plan, problems);
  add_ports(flat, layout, *plan, *lists);
  for (size_t b = 0; b < plan->blocks.size(); ++b)
    plan->block_of_state.insert(plan->block_of_state.end(), size_t(plan->blocks[b].states), int(b));
  plan->without_unit = wires_without_unit(flat, units);
  find_order(*plan, diagram.solver.algebraic_loops.value == "solve", problems);
  check_gates(*plan, problems);
  if (problems.has_errors()) return nullptr;
  add_crossings(*plan);
  add_rates_to_log(*plan);
  plan->parameters = std::move(flat.settings.effective);
  plan->identity = identity_of(*plan, diagram, problems, first_file);
  plan->hash = plan->identity.hash();
  for (const Problem& problem : problems.list()) plan->warnings.push_back(problem);
  return plan;
}

WiresWithoutUnit check_part(const Diagram& diagram, Problems& problems) {
  FlatDiagram flat = flatten(diagram, problems, true);
  find_shapes(flat, problems);
  return wires_without_unit(flat, check_units(flat, diagram, problems));
}

LoadedDiagram load_diagram_and_plan(const std::string& path, const LoadOptions& options) {
  Problems problems;
  LoadedDiagram loaded{load_diagram(path, options, problems), nullptr};
  if (loaded.diagram) loaded.plan = compile(*loaded.diagram, problems);
  if (!loaded.plan || problems.has_errors()) throw InputError(std::move(problems));
  return loaded;
}

std::shared_ptr<const Plan> load_plan(const std::string& path, const LoadOptions& options) {
  return load_diagram_and_plan(path, options).plan;
}

std::vector<Number> Plan::find(std::string_view port) const {
  const size_t bracket = port.find('[');
  const std::string_view name = port.substr(0, bracket);
  const auto found = std::ranges::lower_bound(ports, name, {}, &Port::name);
  if (found == ports.end() || found->name != name) return {};
  const auto numbers = found->numbers;
  if (bracket == port.npos) return {numbers.begin(), numbers.end()};
  const char *first = port.data() + bracket + 1, *last = port.data() + port.size() - 1;
  size_t index = 0;
  const auto [end, code] = std::from_chars(first, last, index);
  if (code != std::errc() || end != last || *last != ']' || index >= numbers.size()) return {};
  return {numbers[index]};
}

std::pair<int, int> Plan::source_of(Number number) const {
  if (sources.empty()) return {-1, -1};
  return sources[size_t(number)];
}

std::optional<Unit> Plan::unit_of(Number number) const {
  const auto [block, output] = source_of(number);
  return block < 0 ? std::nullopt : blocks[size_t(block)].output_units[size_t(output)];
}

std::string Plan::name_of(Number number) const {
  const auto [b, o] = source_of(number);
  if (b < 0) return "a constant";
  const Block& block = blocks[size_t(b)];
  const PortInfo& port = block.type->info.outputs[size_t(o)];
  if (port.shape != PortInfo::Shape::vector) return fmt::format("{}.{}", block.path, port.name);
  return fmt::format("{}.{}[{}]", block.path, port.name, number - block.outputs[size_t(o)]);
}

}  // namespace loopwright
