/// Flattened diagrams: a list of blocks with their types, parameters and resolved wires, without subdiagrams.
#pragma once
#include <deque>
#include <memory_resource>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"
#include "engine/plan/settings.h"

namespace loopwright {

/// The source of a wire: an output of a flat block, or one element of it. Points into the diagram.
struct FlatWire {
  int block = -1, output = -1;
  int element = -1;          ///< -1: the whole port
  const Wire* at = nullptr;  ///< as written in the file; null: not from a file
  bool is_resolved() const { return block >= 0; }
  /// The input of the outermost diagram, if that is examined as a part; -1: none.
  int open_input() const { return block < 0 ? output : -1; }
};

/// The wires of the ports of a block, one list for each port, in the memory of its diagram; empty: not wired.
using FlatInputs = std::pmr::vector<std::pmr::vector<FlatWire>>;

struct FlatBlock {
  std::string path;
  const BlockEntry* entry = nullptr;
  const BlockType* type = nullptr;
  std::shared_ptr<void> value;                  ///< scalar block with its parameters
  std::vector<std::shared_ptr<void>> elements;  ///< of each element, if numbers differ; otherwise empty
  FlatInputs inputs;
  int width = 1;                         ///< number of elements, if scalar ports are wired with vectors
  std::pmr::vector<int> output_lengths;  ///< of the port of one element; 1 until the shapes are known
  int gate = -1;                         ///< of the subdiagram that contains it; -1: it runs all the time
};

/// Decides when a subdiagram runs.
struct FlatGate {
  int block = -1;                     ///< the Enable block made for it
  int parent = -1;                    ///< the gate of the diagram around it; -1: none
  const BlockEntry* entry = nullptr;  ///< the subdiagram
  bool is_triggered = false;          ///< or something around it
};

struct FlatLog {
  std::string name;
  FlatWire wire;
};

/// A port of a subdiagram, which can be requested by its name.
struct FlatName {
  std::string name;
  FlatWire wire;
};

struct FlatDiagram {
  /// Memory of the lists of blocks: contiguous and freed together.
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory =
      std::make_unique<std::pmr::monotonic_buffer_resource>();
  std::vector<FlatBlock> blocks;
  std::vector<FlatGate> gates;                                   ///< each after the gates around it
  std::deque<BlockEntry> made_entries;                           ///< of the blocks that are made for gates
  std::vector<std::shared_ptr<const BlockType>> instance_types;  ///< of blocks with ports of their own
  Settings settings;                                             ///< of the blocks, in their order
  std::deque<Value> extended_settings;  ///< of blocks that do not use them as written
  std::vector<FlatLog> log;
  std::vector<FlatName> names;    ///< ports of blocks have plain names: path.port
  std::vector<FlatName> outputs;  ///< of the outermost diagram
};

/// `open`: inputs of the outermost diagram may have no source, as for a subdiagram examined alone.
FlatDiagram flatten(const Diagram& diagram, Problems& problems, bool open = false);

}  // namespace loopwright
