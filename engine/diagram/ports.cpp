#include "engine/diagram/ports.h"
#include <fmt/format.h>
#include "engine/diagram/wires.h"

namespace loopwright {
namespace {

template <class Read>
void each_port(const Value& root, std::string_view key, const Reader& reader, Read read) {
  const auto* list = root.find(key);
  if (!list || !reader.expect(list->value, Value::Kind::object, fmt::format("\"{}\"", key),
                              "an object of named ports"))
    return;
  for (const Value::Member& member : list->value.members)
    if (reader.check_name(member, "a port")) read(member);
}

std::string unit_text(const Value& object, const Reader& reader) {
  const auto* unit = object.find("unit");
  return unit && reader.unit(unit->value) ? unit->value.text : std::string();
}

}  // namespace

std::vector<DiagramInput> read_inputs_of_diagram(const Value& root, const Reader& reader) {
  std::vector<DiagramInput> inputs;
  each_port(root, "inputs", reader, [&](const Value::Member& member) {
    DiagramInput input{member.name, {}, {}, member.place};
    if (member.value.kind == Value::Kind::text) {
      if (reader.unit(member.value)) input.unit = member.value.text;
    } else if (reader.expect(member.value, Value::Kind::object, "an input",
                             "its unit in quotes, or {\"unit\": …, \"description\": …}")) {
      reader.reject_unknown(member.value, {"unit", "description"}, "an input");
      input.unit = unit_text(member.value, reader);
      input.description = reader.text(member.value, "description");
    }
    inputs.push_back(std::move(input));
  });
  return inputs;
}

std::vector<DiagramOutput> read_outputs_of_diagram(const Value& root, const Reader& reader) {
  std::vector<DiagramOutput> outputs;
  each_port(root, "outputs", reader, [&](const Value::Member& member) {
    DiagramOutput output{member.name, {}, {}, member.place, {}};
    const std::string what = fmt::format("the source of the output \"{}\"", member.name);
    if (member.value.kind != Value::Kind::object) {
      output.source = read_wire(member.value, what, reader);
    } else {
      reader.reject_unknown(member.value, {"source", "unit", "description"}, "an output");
      output.unit = unit_text(member.value, reader);
      output.description = reader.text(member.value, "description");
      if (const auto* source = member.value.find("source"))
        output.source = read_wire(source->value, what, reader);
      else
        reader.error(member, fmt::format("the output \"{}\" has no \"source\"", member.name)).expected =
            "\"source\": \"block.output\"";
    }
    if (!output.source.source.empty()) outputs.push_back(std::move(output));
  });
  return outputs;
}

}  // namespace loopwright
