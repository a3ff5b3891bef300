/// Subdiagrams dissolved: a flat list of blocks with their types, parameters and resolved wires.
#pragma once
#include <memory_resource>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"
#include "engine/plan/settings.h"

namespace loopwright {

/// A wire's source: an output of a flat block, or one element of it. Points into the diagram.
struct FlatWire {
  int block = -1, output = -1;
  int element = -1;          ///< -1: the whole port
  const Wire* at = nullptr;  ///< as the reader wrote it; null: nobody did
  bool is_resolved() const { return block >= 0; }
  /// Which input of the outermost diagram this is, looked at as a part; -1: none.
  int open_input() const { return block < 0 ? output : -1; }
};

/// What feeds the ports of a block, a list each, in the memory of its diagram; empty: not wired.
using FlatInputs = std::pmr::vector<std::pmr::vector<FlatWire>>;

struct FlatBlock {
  std::string path;
  const BlockEntry* entry = nullptr;
  const BlockType* type = nullptr;
  std::shared_ptr<void> value;  ///< scalar block, parameters read
  FlatInputs inputs;
  int width = 1;                         ///< elements, when scalar ports are wired with vectors
  std::pmr::vector<int> output_lengths;  ///< of one element's port; 1 until the shapes are found
};

struct FlatLog {
  std::string name;
  FlatWire wire;
};

/// A port of a subdiagram, under which what it leads to can be asked for.
struct FlatName {
  std::string name;
  FlatWire wire;
};

struct FlatDiagram {
  /// Of the lists of blocks: one after the other, and given back at once.
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory =
      std::make_unique<std::pmr::monotonic_buffer_resource>();
  std::vector<FlatBlock> blocks;
  Settings settings;  ///< of the blocks, in their order
  std::vector<FlatLog> log;
  std::vector<FlatName> names;    ///< those of blocks are plain: path.port
  std::vector<FlatName> outputs;  ///< of the outermost diagram
};

/// `open`: inputs of the outermost diagram may lack a source, as those of a subdiagram looked at alone do.
FlatDiagram flatten(const Diagram& diagram, Problems& problems, bool open = false);

}  // namespace loopwright
