#include "engine/plan/scope.h"
#include <fmt/format.h>
#include "engine/block/registry.h"

namespace loopwright {

std::string outputs_of(const Scope& scope, const std::string& name) {
  const int block = scope.blocks.find(name);
  if (block < 0) return "";
  std::vector<std::string> outputs;
  const BlockEntry& entry = scope.diagram->blocks[size_t(block)];
  if (entry.subdiagram)
    for (const DiagramOutput& output : entry.subdiagram->outputs) outputs.push_back(name + "." + output.name);
  else if (const BlockType* type = find_block(entry.type))
    for (const PortInfo& port : type->info.outputs) outputs.push_back(fmt::format("{}.{}", name, port.name));
  return outputs.empty() ? "" : fmt::format("did you mean \"{}\"?", fmt::join(outputs, "\" or \""));
}

}  // namespace loopwright
