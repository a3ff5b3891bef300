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

/// The reference page docs/blocks.md.
std::string block_reference();

}  // namespace loopwright
