/// Reference of diagram contents, generated from the blocks' own descriptions.
#pragma once
#include <string>
#include <vector>
#include "engine/block/registry.h"

namespace loopwright {

/// One block type for a terminal: sentence, ports, parameters with units, ranges and defaults, events.
std::string block_text(const BlockInfo& info);

/// All types by room, one line each.
std::string block_list();

/// A block that was found, or a name in another program with what is equivalent here.
struct FoundBlock {
  enum class Where { name, elsewhere, description };
  Where where = Where::name;
  std::string name;  ///< of the block, or in the other program
  std::string text;  ///< its sentence, or advice
  std::string type;  ///< the block; empty: none is equivalent
};
/// The best matches first; see found_blocks.
std::vector<FoundBlock> find_blocks(std::string_view words);

/// Blocks whose name or description contains these words, and what they are called in other programs ("mux",
/// "Transfer Fcn", "anti-windup"); empty if nothing was found.
std::string found_blocks(std::string_view words);

/// The reference page docs/blocks.md, with links to the pictures of blocks, NAME.svg, that exist in a folder.
std::string block_reference(const std::string& pictures = "");

}  // namespace loopwright
