#include "tools/effects/wire_reader.h"
#include <fmt/format.h>
#include <limits>
#include <set>
#include "engine/block/registry.h"

namespace loopwright {
namespace {

constexpr int out_of_reach = std::numeric_limits<int>::max();

const std::vector<Value::Member>& blocks_of(const Nest::Level& level) {
  return level.diagram->find("blocks")->value.members;
}

/// Wires between two blocks, along their direction.
int distance(const Nest::Level& level, const std::string& from, const std::string& target) {
  std::set<std::string> reached{from};
  for (int wires = 0;; ++wires) {
    if (reached.contains(target)) return wires;
    std::set<std::string> next = reached;
    for (const Value::Member& block : blocks_of(level))
      each_wire(block.value, [&](const Value& wire) {
        if (reached.contains(block_of(wire.text))) next.insert(block.name);
      });
    if (next == reached) return out_of_reach;
    reached = std::move(next);
  }
}

}  // namespace

std::string port_of(const WireReader& reader) {
  for (const Value::Member& port : reader.block->value.find("in")->value.members) {
    if (&port.value == reader.wire) return port.name;
    for (size_t i = 0; i < port.value.items.size(); ++i)
      if (&port.value.items[i] == reader.wire) return fmt::format("{}[{}]", port.name, i);
  }
  return "";
}

std::string block_of(const std::string& port) { return port.substr(0, port.find('.')); }

std::vector<WireReader> nearest_readers(const Nest::Level& level, const std::string& source,
                                        const std::string& target) {
  std::vector<WireReader> readers;
  int nearest = out_of_reach;
  for (const Value::Member& block : blocks_of(level))
    each_wire(block.value, [&](const Value& wire) {
      if (wire.text != source) return;
      const int wires = distance(level, block.name, target);
      if (wires > nearest) return;
      if (wires < nearest) readers.clear(), nearest = wires;
      readers.push_back({&block, &wire});
    });
  return readers;
}

std::vector<WireReader> readers_but_mechanics(const Nest& nest, const Nest::Level& level,
                                              const std::string& source) {
  std::vector<WireReader> readers;
  for (const Value::Member& block : blocks_of(level)) {
    const BlockType* type = find_block(type_of(*nest.body(level, block)));
    if (type && type->info.room == "mechanics") continue;
    each_wire(block.value, [&](const Value& wire) {
      if (wire.text == source) readers.push_back({&block, &wire});
    });
  }
  return readers;
}

void redirect(const Nest::Level& level, const std::vector<WireReader>& readers, const std::string& source) {
  for (const WireReader& reader : readers) {
    const size_t at = reader.wire->place.offset;
    level.document->edits.replace(at, end_of_value(level.document->text(), at), "\"" + source + "\"");
  }
}

const Value::Member* block_before(const Nest::Level& level, const Value::Member& reader,
                                  const std::string& type) {
  const Value::Member* found = nullptr;
  each_wire(reader.value, [&](const Value& wire) {
    const Value::Member* block = level.block(block_of(wire.text));
    if (!found && block && type_of(block->value) == type) found = block;
  });
  if (found) return found;
  for (const Value::Member& block : blocks_of(level))
    if (type_of(block.value) == type) return &block;
  return nullptr;
}

}  // namespace loopwright
