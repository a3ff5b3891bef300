#include "engine/diagram/variants.h"

#include <algorithm>
#include <fmt/format.h>

namespace loopwright {
namespace {

/// Conditions that also apply to inactive variants. Their files are not opened, as hardware may be absent.
void check_variant(const Value::Member& variant, const Reader& reader) {
  reader.check_name(variant, "a variant");
  const std::string_view expected = "an object: {\"type\": …} or {\"diagram\": …}";
  if (!reader.expect(variant.value, Value::Kind::object, "a variant", expected)) return;
  if (variant.value.find("type") || variant.value.find("diagram")) return;
  reader.error(variant, fmt::format("the variant \"{}\" has neither \"type\" nor \"diagram\"", variant.name));
}

void choose(const Value& chosen, const Value& variants, BlockEntry& entry, const Reader& reader) {
  if (variants.find(chosen.text)) {
    entry.variant = chosen.text;
    return;
  }
  KnownNames names;
  for (const Value::Member& variant : variants.members) names.add(variant.name);
  names.explain(reader.error(chosen, fmt::format("the block has no variant \"{}\"", chosen.text)),
                chosen.text);
}

}  // namespace

std::optional<VariantChoice> read_variant_choice(const std::string& path, const std::string& variant,
                                                 Problems& problems) {
  const auto source = std::make_shared<SourceFile>(SourceFile{fmt::format("--variant {}", path), variant});
  VariantChoice choice{split_path(path), 0, variant, {source, 0}};
  if (std::ranges::all_of(choice.path, is_name)) return choice;
  Problem& problem = problems.error({source, 0}, {}, {}, fmt::format("\"{}\" is no path of a block", path));
  problem.expected = "names with dots between them, as in axis.stage=quanser";
  return {};
}

const Value* active_variant(const Value& block, BlockEntry& entry, std::vector<VariantChoice>& choices,
                            const Reader& reader) {
  reader.reject_unknown(block, {"variants", "variant", "in", "description"}, "a block with variants");
  reader.text(block, "description");
  const Value& variants = block.find("variants")->value;
  const std::string_view expected = "an object: {\"name\": {\"type\": …}}";
  if (!reader.expect(variants, Value::Kind::object, "\"variants\"", expected)) return nullptr;
  if (variants.members.empty()) {
    reader.error(variants, "there is no variant to choose");
    return nullptr;
  }
  for (const Value::Member& variant : variants.members) check_variant(variant, reader);

  entry.variant = variants.members.front().name;
  const Value::Member* written = block.find("variant");
  if (written &&
      reader.expect(written->value, Value::Kind::text, "\"variant\"", "the name of a variant in quotes"))
    choose(written->value, variants, entry, reader);
  std::erase_if(choices, [&](const VariantChoice& choice) {
    if (!choice.is_here()) return false;
    Value chosen;
    chosen.text = choice.variant;
    chosen.place = choice.place;
    choose(chosen, variants, entry, reader);
    return true;
  });
  const Value& body = variants.find(entry.variant)->value;
  return body.kind == Value::Kind::object ? &body : nullptr;
}

}  // namespace loopwright
