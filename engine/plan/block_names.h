/// Blocks of a flat diagram by name.
#pragma once
#include <bit>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>
#include "engine/plan/flatten.h"

namespace loopwright {

/// The ordinary blocks of one diagram by name. A search looks at one spot of a small table, then at the block
/// that it found: std::unordered_map leads through a list of nodes, and among 100,000 each step waits for
/// memory.
class BlockNames {
 public:
  /// For at most so many of `blocks`, whose paths begin with `prefix` letters that are not of the name.
  BlockNames(const std::vector<FlatBlock>& blocks, size_t prefix, size_t most)
      : blocks_(blocks), prefix_(prefix), slots_(std::bit_ceil(most + most / 4 + 1)) {}
  void add(int block) {
    const std::string_view name = name_of(block);
    const uint32_t hash = hash_of(name);
    slots_[slot_of(name, hash)] = {hash, block};
  }
  /// -1: there is none.
  int find(std::string_view name) const { return slots_[slot_of(name, hash_of(name))].block; }

 private:
  struct Slot {
    uint32_t hash = 0;
    int block = -1;  // free
  };
  static uint32_t hash_of(std::string_view name) { return uint32_t(std::hash<std::string_view>()(name)); }
  std::string_view name_of(int block) const {
    return std::string_view(blocks_[size_t(block)].path).substr(prefix_);
  }
  /// Where the name stands, or the free slot that it would take: the first such from its hash on.
  size_t slot_of(std::string_view name, uint32_t hash) const {
    size_t at = hash & (slots_.size() - 1);
    while (slots_[at].block >= 0 && (slots_[at].hash != hash || name_of(slots_[at].block) != name))
      at = (at + 1) & (slots_.size() - 1);
    return at;
  }

  const std::vector<FlatBlock>& blocks_;
  size_t prefix_;
  std::vector<Slot> slots_;  // a power of two of them, never full
};

}  // namespace loopwright
