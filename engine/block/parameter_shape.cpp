#include "engine/block/parameter_shape.h"
#include "engine/block/instance_ports.h"

namespace loopwright {
namespace {

std::string described(const ParameterInfo& p) {
  std::string text(p.sentence);
  if (!p.unit.empty() && p.unit != unit_of_output && !text.empty()) text += " [" + std::string(p.unit) + "]";
  return text;
}

FileShape numbers(const ParameterInfo& p, FileShape shape) {
  shape.low = p.low, shape.high = p.high, shape.low_is_open = p.low_is_open;
  return shape;
}

FileShape without_words(const ParameterInfo& p, Writing writing) {
  switch (p.kind) {
    case ParameterKind::number:
      return numbers(p, shapes::number());
    case ParameterKind::whole:
      return numbers(p, shapes::whole(p.low, p.high));
    case ParameterKind::flag:
      return shapes::flag();
    case ParameterKind::text:
    case ParameterKind::file:
      return shapes::text();
    case ParameterKind::choice:
      return shapes::choice(p.choices);
    case ParameterKind::list:
      return shapes::list(shape_of(p.element.front(), writing));
    case ParameterKind::by_name:
      return shapes::by_name(shape_of(p.element.front(), writing));
    case ParameterKind::object:
      return shape_of(p.fields, writing);
  }
  return shapes::anything();
}

}  // namespace

FileShape shape_of(const ParameterInfo& parameter, Writing writing) {
  FileShape shape = without_words(parameter, writing);
  shape.is_evaluated = writing == Writing::evaluated;
  shape.sentence = described(parameter);
  shape.default_text = parameter.default_text;
  return shape;
}

FileShape shape_of(const std::vector<ParameterInfo>& fields, Writing writing) {
  std::vector<FileShape::Key> keys;
  for (const ParameterInfo& field : fields)
    keys.push_back({field.name, shape_of(field, writing), !field.has_default});
  return shapes::object(std::move(keys));
}

}  // namespace loopwright
