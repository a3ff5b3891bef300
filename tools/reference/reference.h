/// Reference of diagram contents, generated from the blocks' own descriptions.
#pragma once
#include <string>
#include "engine/block/registry.h"

namespace loopwright {

/// JSON Schema (draft 2020-12) of diagram files, for editors.
std::string diagram_schema();

/// One block type for a terminal: sentence, ports, parameters with units, ranges and defaults, events.
std::string block_text(const BlockInfo& info);

/// All types by room, one line each.
std::string block_list();

/// Blocks whose name or description contains these words, and what they are called in other programs ("mux",
/// "Transfer Fcn", "anti-windup"); empty if nothing was found.
std::string found_blocks(std::string_view words);

/// The reference page docs/blocks.md.
std::string block_reference();

}  // namespace loopwright
