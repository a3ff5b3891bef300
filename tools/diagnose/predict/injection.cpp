#include "tools/diagnose/predict/injection.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/predict/block_value.h"

namespace loopwright::diagnosis {
namespace {

/// An additional + term.
bool extend(BlockEntry& sum) {
  const auto terms = std::ranges::find(sum.in, "terms", &PortWires::port);
  if (sum.type != "Sum" || terms == sum.in.end()) return false;
  const Value::Member* signs = sum.settings.find("signs");
  if (signs && !signs->value.text.empty())
    set_member(sum.settings, "signs", text_value(signs->value.text + "+"));
  terms->is_list = true;
  terms->wires.push_back({std::string(injected_force) + ".y", terms->place});
  return true;
}

/// Follows "axis.net_force" through outputs of subdiagrams to the block behind it, copying along the way.
std::shared_ptr<Diagram> inject(const Diagram& diagram, const std::string& port, std::string& parent) {
  auto copy = std::make_shared<Diagram>(diagram);
  const size_t dot = port.find('.');
  const std::string name = port.substr(0, dot), rest = dot == port.npos ? "" : port.substr(dot + 1);
  const auto entry = std::ranges::find(copy->blocks, name, &BlockEntry::name);
  if (entry == copy->blocks.end()) return nullptr;
  if (entry->subdiagram) {
    parent += name + ".";
    std::string inner_port = rest;
    for (const DiagramOutput& output : entry->subdiagram->outputs)
      if (output.name == rest) inner_port = output.source.source;
    auto inner = inject(*entry->subdiagram, inner_port, parent);
    if (!inner) return nullptr;
    entry->subdiagram = std::move(inner);
    return copy;
  }
  if (!extend(*entry)) return nullptr;
  BlockEntry constant;
  constant.name = injected_force, constant.type = "Constant";
  constant.place = constant.type_place = entry->place;
  Value zero;
  zero.kind = Value::Kind::number;
  constant.settings.place = entry->place;
  set_member(constant.settings, "value", zero);
  copy->blocks.push_back(std::move(constant));
  return copy;
}

}  // namespace

std::shared_ptr<const Diagram> with_injected_force(const Diagram& diagram, const std::string& port,
                                                   const Place& place, Problems& problems,
                                                   std::string& parent) {
  auto changed = inject(diagram, port, parent);
  if (!changed) {
    auto& p = problems.error(place, "/roles/force", "",
                             "further forces cannot act where the role \"force\" points");
    p.expected = "the output of a Sum that adds up the forces on the moving part";
    p.found = port;
  }
  return changed;
}

}  // namespace loopwright::diagnosis
