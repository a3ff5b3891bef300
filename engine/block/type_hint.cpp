#include <fmt/format.h>
#include "engine/block/registry.h"
#include "engine/diagram/names_elsewhere.h"

namespace loopwright {

std::string block_type_hint(std::string_view type) {
  const std::string name = plain_name(type);
  std::vector<std::string> types;
  for (const auto& [known, unused] : all_blocks()) {
    const std::string plain = plain_name(known);
    if (plain == name || plain == without_number(name)) return fmt::format("did you mean \"{}\"?", known);
    types.push_back(known);
  }
  if (const NameElsewhere* entry = find_name_elsewhere(type))
    return entry->block.empty() ? advice(*entry) : fmt::format("did you mean {}?", advice(*entry));
  const std::string near = nearest_name(type, types);
  return near.empty() ? "`loopwright blocks` lists all types" : fmt::format("did you mean \"{}\"?", near);
}

}  // namespace loopwright
