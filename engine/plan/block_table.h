/// The blocks of one diagram by name.
#pragma once
#include <bit>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A slot holds a block and the beginning of the hash of its name, eight bytes in total. A table for a
/// hundred thousand blocks therefore fits into a cache. Names are compared in the diagram.
class BlockTable {
 public:
  explicit BlockTable(const std::vector<BlockEntry>& blocks)
      : blocks_(blocks), slots_(std::bit_ceil(2 * blocks.size() + 1)) {}

  void add(size_t block) {
    const std::string_view name = blocks_[block].name;
    slots_[slot_of(name)] = {hash_of(name), int32_t(block)};
  }
  /// Its index in the diagram; -1: not found.
  int find(std::string_view name) const { return slots_[slot_of(name)].block; }

 private:
  struct Slot {
    uint32_t hash = 0;
    int32_t block = -1;  // none
  };
  static uint32_t hash_of(std::string_view name) { return uint32_t(std::hash<std::string_view>()(name)); }
  /// The slot of the name, or the free slot for it.
  size_t slot_of(std::string_view name) const {
    const uint32_t hash = hash_of(name);
    for (size_t i = hash;; ++i) {
      const Slot& slot = slots_[i & (slots_.size() - 1)];
      if (slot.block < 0 || (slot.hash == hash && blocks_[size_t(slot.block)].name == name))
        return i & (slots_.size() - 1);
    }
  }

  const std::vector<BlockEntry>& blocks_;
  std::vector<Slot> slots_;  // the size is a power of two; at least half are free
};

}  // namespace loopwright
