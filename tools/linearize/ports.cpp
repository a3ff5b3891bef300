#include "tools/linearize/ports.h"
#include <fmt/format.h>
#include "engine/json/reader.h"

namespace loopwright {
namespace {

/// "gain" and "gain[2]" for "gain": a block wired with vectors occurs once for each element.
bool is_element_of(std::string_view path, std::string_view block) {
  if (!path.starts_with(block)) return false;
  return path.size() == block.size() || path[block.size()] == '[';
}

/// An input of blocks, each number with its single reader.
std::vector<PortNumber> block_input(const Plan& plan, std::string_view block, std::string_view port) {
  std::vector<PortNumber> found;
  for (size_t b = 0; b < plan.blocks.size(); ++b) {
    const Plan::Block& candidate = plan.blocks[b];
    if (!is_element_of(candidate.path, block)) continue;
    int at = 0;
    for (size_t i = 0; i < candidate.inputs.size(); ++i) {
      if (candidate.type->info.inputs[i].name == port)
        for (size_t k = 0; k < candidate.inputs[i].size(); ++k)
          found.push_back({"", candidate.inputs[i][k], false, {{int(b), at + int(k)}}});
      at += int(candidate.inputs[i].size());
    }
  }
  return found;
}

bool has_output(const Plan& plan, std::string_view block, std::string_view port) {
  for (const Plan::Block& candidate : plan.blocks)
    if (is_element_of(candidate.path, block))
      for (const PortInfo& output : candidate.type->info.outputs)
        if (output.name == port) return true;
  return false;
}

/// A port of a flattened subdiagram, or an output of a block: identified by the block that computes its
/// number.
std::vector<PortNumber> other_port(const Plan& plan, const std::string& name, const std::string& owner) {
  std::vector<PortNumber> found;
  for (Number number : plan.find(name)) {
    const int source = plan.source_of(number).first;
    const auto is_inside = [&](const std::string& path) {
      return is_element_of(path, owner) || path.starts_with(owner + ".");
    };
    PortNumber port{"", number, source >= 0 && is_inside(plan.blocks[size_t(source)].path), {}};
    for (size_t b = 0; b < plan.blocks.size() && !port.is_output; ++b) {
      if (!is_inside(plan.blocks[b].path)) continue;
      int at = 0;
      for (const auto& input : plan.blocks[b].inputs)
        for (Number read : input) {
          if (read == number) port.readers.emplace_back(int(b), at);
          ++at;
        }
    }
    found.push_back(std::move(port));
  }
  return found;
}

}  // namespace

std::vector<PortNumber> find_port(const Plan& plan, const std::string& port, Problems& problems) {
  const size_t bracket = port.find_last_of('[') > port.find_last_of('.') ? port.find_last_of('[') : port.npos;
  const std::string whole = port.substr(0, bracket);
  const size_t dot = whole.find_last_of('.');
  const std::string owner = whole.substr(0, dot == whole.npos ? 0 : dot);
  const std::string_view name = std::string_view(whole).substr(dot == whole.npos ? 0 : dot + 1);
  const bool says_input = owner.ends_with(".in");
  std::vector<PortNumber> found;
  if (says_input || !has_output(plan, owner, name))
    found = block_input(plan, std::string_view(owner).substr(0, owner.size() - (says_input ? 3 : 0)), name);
  if (found.empty()) found = other_port(plan, whole, owner);
  const bool is_single = found.size() == 1 && bracket == port.npos;
  for (size_t i = 0; i < found.size(); ++i)
    found[i].name = is_single ? whole : fmt::format("{}[{}]", whole, i);
  if (bracket != port.npos) std::erase_if(found, [&](const PortNumber& p) { return p.name != port; });
  if (!found.empty()) return found;
  KnownNames names;
  for (const Plan::Port& known : plan.ports) names.add(std::string(known.name));
  names.explain(problems.error({}, "", "", fmt::format("there is no port \"{}\"", port)), port);
  return {};
}

}  // namespace loopwright
