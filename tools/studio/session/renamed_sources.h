/// Every place of a diagram that names a signal, and what follows when a block gets another path.
#pragma once
#include "tools/studio/session/draft.h"
#include "tools/studio/session/written_wires.h"

namespace loopwright::studio {

namespace detail {
template <class F> void each_text(const Value& value, F&& f) {
  if (value.kind == Value::Kind::text) f(value);
  for (const Value& item : value.items)
    if (item.kind == Value::Kind::text) f(item);
}
}  // namespace detail

/// f(wire) for every wire into a block, in all of its variants.
template <class F> void each_source_of_block(const Value& block, F&& f) {
  const auto each_of = [&](const Value& body) {
    each_wire(body, [&](const std::string&, const Value& wire, size_t) { f(wire); });
  };
  each_of(block);
  if (const Value::Member* variants = block.find("variants"))
    for (const Value::Member& variant : variants->value.members) each_of(variant.value);
}
/// f(source) for every output of a diagram.
template <class F> void each_source_of_outputs(const Value& diagram, F&& f) {
  const Value::Member* outputs = diagram.find("outputs");
  if (!outputs) return;
  for (const Value::Member& output : outputs->value.members) {
    if (output.value.kind == Value::Kind::text) f(output.value);
    if (const Value::Member* source = output.value.find("source")) detail::each_text(source->value, f);
  }
}
/// f(signal) for everything that a diagram records.
template <class F> void each_recorded(const Value& diagram, F&& f) {
  if (const Value::Member* log = diagram.find("log")) detail::each_text(log->value, f);
}
/// f(signal) for everything that the figures of a diagram are about.
template <class F> void each_in_figures(const Value& diagram, F&& f) {
  const Value::Member* figures = diagram.find("figures");
  if (!figures) return;
  for (const Value& figure : figures->value.items)
    for (const std::string_view key : {"signal", "reference"})
      if (const Value::Member* signal = figure.find(key))
        if (signal->value.kind == Value::Kind::text) f(signal->value);
}
template <class F> void each_source(const Value& diagram, F&& f) {
  if (const Value::Member* blocks = diagram.find("blocks"))
    for (const Value::Member& block : blocks->value.members) each_source_of_block(block.value, f);
  each_source_of_outputs(diagram, f);
  each_recorded(diagram, f);
  each_in_figures(diagram, f);
}

/// `path` and everything inside it get another name, wherever the diagram reads them.
TextChanges renamed_sources(const Value& diagram, const std::string& path, const std::string& new_path);
/// The same for a block of a level in the diagrams around it, which may read signals inside.
TextChanges renamed_in_outer_diagrams(const Level& level, const std::string& name, const std::string& to);

/// The uses of a parameter in the expressions of a value.
TextChanges uses_of_parameter(const Value& value, const std::string& name, const std::string& to);

}  // namespace loopwright::studio
