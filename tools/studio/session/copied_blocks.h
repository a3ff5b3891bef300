/// Blocks on the clipboard: a JSON text, {"loopwright_blocks": {"gain": {…}}}.
#pragma once
#include "tools/studio/session/draft.h"

namespace loopwright::studio {

/// Throws Refused if one of them is not there.
std::string copied_blocks(const Level& level, const std::vector<std::string>& names);

struct CopiedBlock {
  std::string name, text;
};

/// The blocks of a clipboard under names that are free in the level. Wires among them lead to the copies;
/// wires from other blocks and inputs are kept where the level has these, otherwise left out. Throws Refused
/// for another text.
std::vector<CopiedBlock> renamed_copies(const std::string& text, const Level& level);

}  // namespace loopwright::studio
