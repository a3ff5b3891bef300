#include "engine/diagram/drive.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <fmt/format.h>
#include "engine/json/reader.h"
#include "engine/diagram/wires.h"

namespace loopwright {
namespace {

/// A name that occurs in none of the lists.
template <class... Entries> std::string unused_name(std::string name, const Entries&... lists) {
  const auto is_in = [&](const auto& list) {
    return std::ranges::any_of(list, [&](const auto& entry) { return entry.name == name; });
  };
  while ((is_in(lists) || ...)) name += '_';
  return name;
}

class Driver {
 public:
  Driver(const Drive& drive, Problems& problems) : drive_(drive), problems_(problems) {}

  /// The block that provides the column is added to `columns`; no other name refers to it.
  void apply(Diagram& top, std::vector<BlockEntry>& columns) {
    if (!is_port(drive_.port)) {
      error("\"" + drive_.port + "\" names no input port", "").expected =
          "a port such as \"axis.force\" or \"command.terms[1]\"";
      return;
    }
    BlockEntry column;
    column.name = drive_.port;
    std::ranges::replace_if(
        column.name, [](char c) { return c == '.' || c == '[' || c == ']'; }, '_');
    column.name = unused_name("recorded_" + column.name, top.blocks, columns);
    column.place = column.type_place = drive_.settings.place;
    column.type = drive_.type;
    column.settings = drive_.settings;
    const Wire wire = wire_from(column.name + "." + drive_.output);

    const std::vector<std::string> path = split_path(drive_.port);
    const bool is_led =
        path.size() == 1 ? replace_input(top, path[0], wire) : lead(top, path, "", column.name, wire);
    if (is_led) columns.push_back(std::move(column));
  }

 private:
  Wire wire_from(std::string source) const { return {std::move(source), drive_.settings.place}; }

  Problem& error(std::string message, std::string block) const {
    return problems_.error(drive_.settings.place, drive_.settings.place.pointer(), std::move(block),
                           std::move(message));
  }

  template <class Entry>
  void unknown(std::string message, std::string block, const std::string& wrong,
               const std::vector<Entry>& entries) const {
    KnownNames names;
    for (const Entry& entry : entries) names.add(entry.name);
    names.explain(error(std::move(message), std::move(block)), wrong);
  }

  /// Removes an input of the outermost diagram; its readers read the column.
  bool replace_input(Diagram& top, const std::string& name, const Wire& wire) const {
    const auto input = std::ranges::find(top.inputs, name, &DiagramInput::name);
    if (input == top.inputs.end()) {
      unknown(fmt::format("the diagram has no input \"{}\" to drive", name), "", name, top.inputs);
      return false;
    }
    top.inputs.erase(input);
    const auto redirect = [&](Wire& reader) {
      const std::string_view element =
          std::string_view(reader.source).substr(std::min(name.size(), reader.source.size()));
      const bool reads_it = reader.source.starts_with(name) && (element.empty() || element.front() == '[');
      if (reads_it) reader.source = wire.source + std::string(element);
    };
    for (BlockEntry& block : top.blocks)
      for (PortWires& port : block.in) std::ranges::for_each(port.wires, redirect);
    for (DiagramOutput& output : top.outputs) redirect(output.source);
    std::ranges::for_each(top.log, redirect);
    return true;
  }

  /// Connects a wire to the port at the end of `path`, whose first name is a block of `diagram`.
  bool lead(Diagram& diagram, std::span<const std::string> path, const std::string& block,
            const std::string& passage, const Wire& wire) const {
    const auto entry = std::ranges::find(diagram.blocks, path[0], &BlockEntry::name);
    if (entry == diagram.blocks.end()) {
      unknown(fmt::format("there is no block \"{}\" to drive", joined(block, path[0])), block, path[0],
              diagram.blocks);
      return false;
    }
    const std::string entry_path = joined(block, entry->name);
    if (path.size() == 2) return replace_wire(*entry, entry_path, path[1], wire);
    if (!entry->subdiagram) {
      error(fmt::format("\"{}\" is not a subdiagram", entry_path), entry_path).found = drive_.port;
      return false;
    }
    auto inner = std::make_shared<Diagram>(*entry->subdiagram);
    const std::string name = unused_name(passage, inner->inputs);
    if (!lead(*inner, path.subspan(1), entry_path, passage, wire_from(name))) return false;
    inner->inputs.push_back({name, "", "recorded column", wire.place});
    entry->subdiagram = std::move(inner);
    entry->in.push_back({name, wire.place, false, {wire}});
    return true;
  }

  bool replace_wire(BlockEntry& entry, const std::string& entry_path, std::string_view port_text,
                    const Wire& wire) const {
    const size_t bracket = port_text.find('[');
    const std::string port_name(port_text.substr(0, bracket));
    if (entry.subdiagram && std::ranges::find(entry.subdiagram->inputs, port_name, &DiagramInput::name) ==
                                entry.subdiagram->inputs.end()) {
      unknown(fmt::format("the subdiagram has no input \"{}\"", port_name), entry_path, port_name,
              entry.subdiagram->inputs);
      return false;
    }
    auto port = std::ranges::find(entry.in, port_name, &PortWires::port);
    if (port == entry.in.end()) port = entry.in.insert(entry.in.end(), {port_name, wire.place, false, {}});
    if (bracket == port_text.npos) {
      port->wires = {wire};
      return true;
    }
    size_t element = 0;
    std::from_chars(port_text.data() + bracket + 1, port_text.data() + port_text.size(), element);
    if (element > port->wires.size()) {
      Problem& problem =
          error(fmt::format("the input \"{}\" has no wire {}", port_name, element), entry_path);
      problem.expected = fmt::format("an index from 0 to {}; the last one adds a wire", port->wires.size());
      return false;
    }
    if (element == port->wires.size()) port->wires.emplace_back();
    port->wires[element] = wire;
    port->is_list = true;
    return true;
  }

  const Drive& drive_;
  Problems& problems_;
};

}  // namespace

void apply_drives(Diagram& top, const std::vector<Drive>& drives, Problems& problems) {
  std::vector<BlockEntry> columns;
  for (const Drive& drive : drives) Driver(drive, problems).apply(top, columns);
  std::ranges::move(columns, std::back_inserter(top.blocks));
}

}  // namespace loopwright
