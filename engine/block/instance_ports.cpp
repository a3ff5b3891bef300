#include "engine/block/instance_ports.h"
#include <deque>
#include "engine/block/registry.h"

namespace loopwright {
namespace {

struct OwnedType {
  BlockType type;
  std::deque<InstancePort> ports;  // the description refers to their texts
};

bool is_named(const PortInfo& port) { return port.shape == PortInfo::Shape::named; }

/// Replaces the named port, which is the last, by scalar ports.
void expand(std::vector<PortInfo>& ports, std::vector<InstancePort> names, OwnedType& owned) {
  if (ports.empty() || !is_named(ports.back())) return;
  PortInfo pattern = ports.back();
  pattern.shape = PortInfo::Shape::scalar;
  ports.pop_back();
  for (InstancePort& name : names) {
    const InstancePort& own = owned.ports.emplace_back(std::move(name));
    pattern.name = own.name, pattern.unit = own.unit, pattern.sentence = own.sentence;
    ports.push_back(pattern);
  }
}

/// An input that was one bit becomes all bits from there on.
void widen_feedthrough(std::vector<PortInfo>& outputs, size_t first_named) {
  for (PortInfo& output : outputs)
    if (output.fed_by >> first_named & 1) output.fed_by |= ~uint64_t(0) << first_named;
}

/// {"velocity": …} by the names of outputs is an object with a field for each output.
void name_fields(ParameterInfo& parameter, const std::vector<PortInfo>& outputs) {
  for (ParameterInfo& element : parameter.element) name_fields(element, outputs);
  for (ParameterInfo& field : parameter.fields) name_fields(field, outputs);
  if (parameter.kind != ParameterKind::by_name || parameter.element[0].unit != unit_of_output) return;
  const ParameterInfo pattern = parameter.element[0];
  parameter.kind = ParameterKind::object;
  parameter.unit = {};
  parameter.element.clear();
  for (const PortInfo& output : outputs) {
    ParameterInfo& field = parameter.fields.emplace_back(pattern);
    field.name = output.name, field.unit = output.unit, field.sentence = output.sentence;
    field.has_default = true;
  }
}

}  // namespace

std::shared_ptr<const BlockType> instance_type(const BlockType& type, const void* block) {
  const BlockInfo& info = type.info;
  if (!info.input_ports && !info.output_ports) return nullptr;
  const auto owned = std::make_shared<OwnedType>(OwnedType{type, {}});
  BlockInfo& own = owned->type.info;
  if (info.input_ports) {
    widen_feedthrough(own.outputs, own.inputs.size() - 1);
    expand(own.inputs, info.input_ports(block), *owned);
  }
  if (info.output_ports) {
    const size_t fixed = own.outputs.size() - 1;
    expand(own.outputs, info.output_ports(block), *owned);
    const std::vector<PortInfo> named(own.outputs.begin() + ptrdiff_t(fixed), own.outputs.end());
    for (ParameterInfo& parameter : own.parameters) name_fields(parameter, named);
  }
  return {owned, &owned->type};
}

}  // namespace loopwright
