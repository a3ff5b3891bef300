#include "tools/reference/reference.h"
#include <fmt/format.h>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace loopwright {
namespace {

std::string range_text(const ParameterInfo& p) {
  if (p.kind != ParameterKind::number && p.kind != ParameterKind::whole && p.kind != ParameterKind::list)
    return "";
  const bool low = std::isfinite(p.low), high = std::isfinite(p.high);
  if (low && high) return fmt::format("{} {:g} to {:g}", p.low_is_open ? "above" : "from", p.low, p.high);
  if (low) return fmt::format("{} {:g}", p.low_is_open ? "above" : "at least", p.low);
  if (high) return fmt::format("at most {:g}", p.high);
  return "";
}

std::string kind_text(const ParameterInfo& p) {
  switch (p.kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::whole:
      return "whole number";
    case ParameterKind::flag:
      return "true or false";
    case ParameterKind::text:
      return "text";
    case ParameterKind::file:
      return "file";
    case ParameterKind::choice: {
      std::string all;
      for (std::string_view c : p.choices) all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", c);
      return all;
    }
    case ParameterKind::list:
      return "list of " + kind_text(p.element.front()) +
             (p.element.front().kind == ParameterKind::object ? "s" : "");
    case ParameterKind::by_name:
      return kind_text(p.element.front()) + "s by name";
    case ParameterKind::object:
      return "object";
  }
  return "";
}

std::string facts_text(const ParameterInfo& p) {
  std::string text = kind_text(p);
  if (p.unit == unit_of_output)
    text += " in the units of the outputs";
  else if (!p.unit.empty())
    text += fmt::format(" in {}", p.unit);
  if (const std::string range = range_text(p); !range.empty()) text += ", " + range;
  if (p.has_default) text += fmt::format(", default {}", p.default_text.empty() ? "none" : p.default_text);
  return text;
}

std::string timing_text(const BlockInfo& info) {
  if (info.is_sampled) return "sampled: needs a sample_time";
  if (info.is_continuous) return "continuous: takes no sample_time";
  return "runs at the rate of what it reads, or at its sample_time";
}

std::string feedthrough_text(const BlockInfo& info, const PortInfo& output) {
  if (output.state >= 0) return "a state";
  std::string names;
  for (size_t i = 0; i < info.inputs.size(); ++i)
    if (output.fed_by >> i & 1) names += fmt::format("{}{}", names.empty() ? "" : ", ", info.inputs[i].name);
  return names.empty() ? "from no input directly" : "directly from " + names;
}

/// The name of the example and the picture of a block whose source is blocks/<room>/<name>.cpp.
std::string file_name_of(const BlockInfo& info) {
  const size_t name = info.source.rfind('/') + 1;
  return std::string(info.source.substr(name, info.source.rfind('.') - name));
}

/// A link from docs/ to the picture of a block, if there is one.
std::string picture_of(const BlockInfo& info, const std::string& pictures) {
  const std::string file = file_name_of(info) + ".svg";
  if (pictures.empty() || !std::filesystem::exists(std::filesystem::path(pictures) / file)) return "";
  return fmt::format("![The example of {}](images/blocks/{})\n\n", info.type, file);
}

void add_fields(std::string& text, const std::vector<ParameterInfo>& list, const std::string& indent,
                std::string_view bullet) {
  for (const ParameterInfo& p : list) {
    text += fmt::format("{}{}{} ({}): {}\n", indent, bullet, p.name, facts_text(p), p.sentence);
    add_fields(text, p.fields, indent + "  ", bullet);
  }
}

}  // namespace

std::string block_text(const BlockInfo& info) {
  std::string text =
      fmt::format("{}  ({})\n  {}\n  {}\n", info.type, info.room, info.sentence, timing_text(info));
  if (!info.inputs.empty()) text += "inputs\n";
  for (const PortInfo& port : info.inputs)
    text += fmt::format("  {} [{}]{}{}: {}\n", port.name, port.unit,
                        port.shape == PortInfo::Shape::many     ? ", any number of wires"
                        : port.shape == PortInfo::Shape::vector ? ", a vector"
                                                                : "",
                        port.is_optional ? fmt::format(", {:g} when not wired", port.otherwise_value) : "",
                        port.sentence);
  if (!info.outputs.empty()) text += "outputs\n";
  for (const PortInfo& port : info.outputs)
    text += fmt::format("  {} [{}]{}: {} ({})\n", port.name, port.unit,
                        port.shape == PortInfo::Shape::vector ? ", a vector" : "", port.sentence,
                        feedthrough_text(info, port));
  if (!info.parameters.empty()) text += "parameters\n";
  add_fields(text, info.parameters, "  ", "");
  if (!info.crossings.empty()) text += "events\n";
  for (const CrossingInfo& crossing : info.crossings) text += fmt::format("  {}\n", crossing.name);
  return text;
}

std::string block_list() {
  std::map<std::string, std::string> rooms;
  for (const auto& [name, type] : all_blocks())
    rooms[type.info.room] += fmt::format("  {:<34} {}\n", name, type.info.sentence);
  std::string text;
  for (const auto& [room, lines] : rooms) text += room + "\n" + lines;
  return text;
}

std::string block_reference(const std::string& pictures) {
  std::string text =
      "# Blocks\n\nGenerated by `loopwright blocks --markdown --pictures docs/images/blocks` from the "
      "blocks' own "
      "descriptions; a test holds this page to them.\n"
      "The pictures show the examples, as `tools/reference/pictures.py` draws them.\n"
      "`$name` in a unit stands for the unit of that port, whatever it is; ports with the same `$name` must "
      "agree.\n";
  std::map<std::string, std::vector<const BlockInfo*>> rooms;
  for (const auto& [name, type] : all_blocks()) rooms[type.info.room].push_back(&type.info);
  for (const auto& [room, list] : rooms) {
    text += fmt::format("\n## {}\n", room);
    for (const BlockInfo* info : list) {
      std::string timing = timing_text(*info);
      timing[0] = char(std::toupper(timing[0]));
      text += fmt::format("\n### {}\n{} {}. [Example](../diagrams/examples/{}.json).\n\n", info->type,
                          info->sentence, timing, file_name_of(*info));
      text += picture_of(*info, pictures);
      for (const PortInfo& port : info->inputs)
        text +=
            fmt::format("- in `{}` [{}]{}: {}\n", port.name, port.unit,
                        port.is_optional ? fmt::format(", {:g} when not wired", port.otherwise_value) : "",
                        port.sentence);
      for (const PortInfo& port : info->outputs)
        text += fmt::format("- out `{}` [{}]: {} ({})\n", port.name, port.unit, port.sentence,
                            feedthrough_text(*info, port));
      add_fields(text, info->parameters, "", "- ");
      for (const CrossingInfo& crossing : info->crossings)
        text += fmt::format("- event `{}`\n", crossing.name);
    }
  }
  return text;
}

}  // namespace loopwright
