#include "engine/diagram/block_reader.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include "engine/diagram/run_condition.h"
#include "engine/diagram/wires.h"
#include "engine/diagram/solver_settings.h"
#include "engine/diagram/value_file.h"

namespace loopwright {
namespace {

class BlockReader {
 public:
  BlockReader(const Surroundings& around, const Reader& reader) : around_(around), reader_(reader) {}

  void read(const Value::Member& member, std::vector<Edit> edits, std::vector<VariantChoice> variants,
            BlockEntry& entry) {
    if (!reader_.expect(member.value, Value::Kind::object, "a block",
                        "an object: {\"type\": …, \"in\": {…}}"))
      return;
    if (const auto* in = member.value.find("in")) entry.in = read_inputs(in->value, reader_);

    const Value* body = &member.value;
    const bool has_variants = member.value.find("variants") != nullptr;
    if (has_variants)
      body = active_variant(member.value, entry, variants, reader_);
    else
      reject_choices(variants);
    if (!body) return;

    Value copy;
    const bool is_subdiagram = body->find("diagram") != nullptr;
    if (!edits.empty() && !is_subdiagram) {
      copy = *body;
      for (const Edit& edit : edits) edit_settings(edit, copy);
      body = &copy;
    }
    if (is_subdiagram)
      read_subdiagram(*body, entry, std::move(edits), std::move(variants), has_variants);
    else
      read_ordinary(*body, entry, std::move(variants), has_variants);
  }

 private:
  void edit_settings(const Edit& edit, Value& body) const {
    constexpr std::array reserved = {"type",     "in",      "diagram",    "parameters",
                                     "variants", "variant", "description"};
    const bool names_setting = edit.depth < edit.path.size();
    if (names_setting && std::ranges::find(reserved, edit.head()) == reserved.end())
      return apply_edit(edit, body, reader_, [&](Value& value) { take_from_file(value, reader_); });
    Problem& problem = reader_.error(edit.value, fmt::format("\"{}\" cannot be set", edit.text()));
    problem.expected = "the path of a parameter, or of a setting of a block";
    if (names_setting && edit.head() == "variant") problem.hint = "--variant chooses a variant";
  }

  void read_ordinary(const Value& body, BlockEntry& entry, std::vector<VariantChoice> deeper,
                     bool is_variant) {
    for (const VariantChoice& choice : deeper) {
      const std::string message = fmt::format("the block \"{}\" is not a subdiagram", reader_.block);
      reader_.problems.error(choice.place, {}, reader_.block, message);
    }
    constexpr std::array<std::string_view, 5> engine_keys = {"type", "in", "sample_time", "sample_offset",
                                                             "description"};
    const auto is_setting = [&](const Value::Member& member) {
      return std::ranges::find(engine_keys, member.name) == engine_keys.end();
    };
    entry.settings.members.reserve(size_t(std::ranges::count_if(body.members, is_setting)));
    for (const Value::Member& member : body.members) {
      if (is_misplaced_key(member, is_variant) || !is_setting(member)) continue;
      entry.settings.members.push_back(
          {member.name, member.place, around_.scope.evaluate(member.value, reader_.block)});
    }
    entry.settings.place = body.place;
    reader_.text(body, "description");
    if (const auto* time = body.find("sample_time"))
      entry.sample_time = read_time(time->value, "sample_time", around_.scope, reader_);
    if (const auto* offset = body.find("sample_offset"))
      entry.sample_offset = read_time(offset->value, "sample_offset", around_.scope, reader_);
    read_type(body, entry);
  }

  /// Keys of the engine that have no effect here.
  bool is_misplaced_key(const Value::Member& member, bool is_variant) const {
    if (member.name == "parameters") {
      reader_.error(member, "only a subdiagram has \"parameters\"").hint =
          "settings of a block stand directly in its object";
      return true;
    }
    if (member.name == "variants" || member.name == "variant") {
      reader_.error(member, is_variant ? "variants cannot stand inside a variant"
                                       : "\"variant\" chooses among \"variants\", which are missing");
      return true;
    }
    if (member.name == "in" && is_variant) {
      reader_.error(member, "a variant cannot have its own wires").hint =
          "\"in\" stands beside \"variants\", for all of them";
      return true;
    }
    return false;
  }

  void read_type(const Value& body, BlockEntry& entry) const {
    const auto* type = body.find("type");
    if (!type) {
      Problem& problem = reader_.error(body, "the block has neither \"type\" nor \"diagram\"");
      for (const Value::Member& member : body.members)
        if (const std::string near = nearest_name(member.name, {"type", "diagram", "variants"});
            !near.empty())
          problem.hint = fmt::format("did you mean \"{}\" for \"{}\"?", near, member.name);
      return;
    }
    if (!reader_.expect(type->value, Value::Kind::text, "\"type\"", "the name of a block type in quotes"))
      return;
    entry.type_place = type->value.place;
    if (type->value.text.empty()) reader_.error(type->value, "the block type is empty");
    entry.type = type->value.text;
  }

  void read_subdiagram(const Value& body, BlockEntry& entry, std::vector<Edit> edits,
                       std::vector<VariantChoice> variants, bool is_variant) {
    for (const Value::Member& member : body.members) {
      constexpr std::array known = {"diagram",    "parameters",   "in",   "description",
                                    "enabled_by", "triggered_by", "edge", "while_disabled"};
      const bool is_known = std::ranges::find(known, member.name) != known.end();
      if (is_known && !(is_variant && member.name == "in")) continue;
      if (member.name != "parameters" && is_misplaced_key(member, is_variant)) continue;
      Problem& problem = reader_.error(member, fmt::format("a subdiagram has no key \"{}\"", member.name));
      KnownNames({known.begin(), known.end()}).explain(problem, member.name);
      if (member.name == "type")
        problem.hint = "an entry has either \"type\" or \"diagram\"";
      else if (member.name.starts_with("sample_"))
        problem.hint = "sample times belong to the blocks inside";
      else if (problem.hint.empty())
        problem.hint = "parameters of the diagram stand in \"parameters\"";
    }
    reader_.text(body, "description");
    entry.condition = read_run_condition(body, reader_);
    const Value& path = body.find("diagram")->value;
    const bool is_inline = path.kind == Value::Kind::object;
    const bool has_path =
        is_inline || reader_.expect(path, Value::Kind::text, "\"diagram\"",
                                    "the path of a diagram file in quotes, or a diagram in braces");

    Instance inner{reader_.block, {}, {}, std::move(variants)};
    if (const auto* parameters = body.find("parameters")) inner.overrides = overrides(parameters->value);
    for (Edit& edit : edits) {
      if (edit.depth == edit.path.size()) {
        edit_settings(edit, entry.settings);
      } else {
        if (edit.is_last())
          edit.value =
              around_.scope.evaluate(edit.value, reader_.block);  // over the outer names, like an override
        inner.edits.push_back(std::move(edit));
      }
    }
    if (!has_path) return;
    if (is_inline) {
      entry.type_place = path.place;
      entry.subdiagram =
          around_.load.read(path, BlockList(path.find("blocks")), around_.path, std::move(inner));
      return;
    }
    if (path.text.empty()) {
      reader_.error(path, "the path of the diagram is empty");
      return;
    }
    entry.type_place = path.place;
    const std::string resolved = resolve_relative(path.place, path.text);
    entry.subdiagram = around_.load.load(resolved, path.place, std::move(inner));
  }

  std::vector<Override> overrides(const Value& parameters) {
    std::vector<Override> list;
    if (!reader_.expect(parameters, Value::Kind::object, "\"parameters\"", "an object of named values"))
      return list;
    for (const Value::Member& member : parameters.members)
      list.push_back({member.name, member.place, around_.scope.evaluate(member.value, reader_.block)});
    return list;
  }

  /// `--variant` for a block without variants.
  void reject_choices(std::vector<VariantChoice>& choices) {
    std::erase_if(choices, [&](const VariantChoice& choice) {
      if (!choice.is_here()) return false;
      const std::string message = fmt::format("the block \"{}\" has no variants", reader_.block);
      reader_.problems.error(choice.place, {}, reader_.block, message);
      return true;
    });
  }

  const Surroundings& around_;
  const Reader& reader_;
};

}  // namespace

void read_block(const Value::Member& member, std::vector<Edit> edits, std::vector<VariantChoice> variants,
                const Surroundings& around, const Reader& reader, BlockEntry& entry) {
  BlockReader(around, reader).read(member, std::move(edits), std::move(variants), entry);
}

}  // namespace loopwright
