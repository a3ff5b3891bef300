/// Names of nested diagrams.
#pragma once
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/plan/block_table.h"

namespace loopwright {

/// One diagram of the nesting, with the meaning of its names.
struct Scope {
  const Diagram* diagram;
  std::string prefix;       // "" or "stage."
  const BlockEntry* entry;  // in the parent; null at the top level
  Scope* parent;
  int gate = -1;  ///< that decides when its blocks run; -1: they run all the time
  /// The result for a block: an index in the flat list, a subdiagram, or nothing after errors.
  struct Part {
    int flat_block = -1;
    Scope* inner = nullptr;
  };
  std::vector<Part> parts{};  // of each block
  /// The blocks made for its outputs, if these are reset while it is disabled; otherwise empty.
  std::vector<int> reset_outputs{};
  BlockTable blocks{diagram->blocks};
};

/// A hint with the outputs of a block whose name stands in place of one of its outputs; empty: none.
std::string outputs_of(const Scope& scope, const std::string& name);

}  // namespace loopwright
