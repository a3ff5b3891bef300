/// Subdiagrams dissolved: a flat list of blocks with their types, parameters and resolved wires.
#pragma once
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"

namespace loopwright {

/// A wire's source: an output of a flat block, or one element of it.
struct FlatWire {
  int block = -1, output = -1;
  int element = -1;  ///< -1: the whole port
  Place place;
  std::string pointer, text;
  bool is_resolved() const { return block >= 0; }
};

struct FlatBlock {
  std::string path;
  const BlockEntry* entry = nullptr;
  const BlockType* type = nullptr;
  std::shared_ptr<void> value;                ///< scalar block, parameters read
  std::vector<std::vector<FlatWire>> inputs;  ///< a port each; empty: not wired
  int width = 1;                              ///< elements, when scalar ports are wired with vectors
  std::vector<int> output_lengths;            ///< of one element's port
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
  std::vector<FlatBlock> blocks;
  std::vector<FlatLog> log;
  std::vector<FlatName> names;  ///< those of blocks are plain: path.port
};

/// `open`: inputs of the outermost diagram may lack a source, as those of a subdiagram looked at alone do.
FlatDiagram flatten(const Diagram& diagram, Problems& problems, bool open = false);

}  // namespace loopwright
