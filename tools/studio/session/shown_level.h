/// One level of a diagram, across the files of its subdiagrams.
#pragma once
#include "tools/studio/session/checked_text.h"

namespace loopwright::studio {

/// The level that is shown: its text, which may be that of another file, and what was loaded of it.
struct ShownLevel {
  std::shared_ptr<const ParsedText> owner;
  const Value* diagram = nullptr;
  const Diagram* loaded = nullptr;  // null: not as far
  std::string inside;
  bool is_editable = true;
  Json levels = Json::array();
};

/// A block of a loaded diagram; null if it was not loaded as far.
const BlockEntry* entry_of(const Diagram* diagram, const std::string& name);

/// Throws Refused if `inside` leads to no subdiagram, or to one that cannot be read.
ShownLevel find_shown_level(const CheckedText& text, const std::string& inside, const Variants& variants);

}  // namespace loopwright::studio
