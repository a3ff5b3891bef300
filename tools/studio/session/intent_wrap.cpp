/// The intent that puts blocks into a subdiagram of their own, written where the first of them stood.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/renamed_sources.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

/// "gain.y[2]" → block "gain", port "gain.y", element "[2]"; "force" → no block.
struct Source {
  std::string block, port, element;
  explicit Source(const std::string& text) {
    const size_t bracket = std::min(text.find('['), text.size()), dot = text.find('.');
    port = text.substr(0, bracket), element = text.substr(bracket);
    if (dot != text.npos) block = text.substr(0, dot);
  }
};

/// Names for ports that no two of them share.
class PortNames {
 public:
  explicit PortNames(std::set<std::string> taken) : taken_(std::move(taken)) {}
  /// Of what a source gives: its port, with its block before it if that is taken.
  std::string name_of(const Source& source) {
    if (const auto found = names_.find(source.port); found != names_.end()) return found->second;
    std::string name = source.port.substr(source.port.rfind('.') + 1);
    if (taken_.contains(name)) name = source.port;
    std::ranges::replace(name, '.', '_');
    const std::string wanted = name;
    for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}_{}", wanted, i);
    return names_[source.port] = name;
  }
  bool empty() const { return names_.empty(); }
  const std::map<std::string, std::string>& names() const { return names_; }  ///< by source

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::string> names_;
};

/// All words of a text that could be names of parameters.
void add_words(const std::string& text, std::set<std::string>& words) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (size_t at = 0; at < text.size();) {
    size_t end = at;
    while (end < text.size() && is_part(text[end])) ++end;
    if (end > at) words.insert(text.substr(at, end - at));
    at = end + 1;
  }
}
void add_words(const Value& value, std::set<std::string>& words) {
  if (value.kind == Kind::text) add_words(value.text, words);
  for (const Value& item : value.items) add_words(item, words);
  for (const Value::Member& member : value.members)
    if (member.name != "in" && member.name != "type" && member.name != "description")
      add_words(member.value, words);
}

class Wrapping {
 public:
  Wrapping(const Level& level, const std::vector<std::string>& names, std::string name)
      : level_(level), wrapped_(names.begin(), names.end()), name_(std::move(name)), inputs_(wrapped_) {
    for (const std::string& wrapped : names) required_block(level, wrapped);
  }

  TextChanges changes() {
    const Value& blocks = level_.blocks();
    std::vector<bool> out;
    const Value::Member* first = nullptr;
    std::string inner;
    for (const Value::Member& block : blocks.members) {
      const bool is_wrapped = wrapped_.contains(block.name);
      out.push_back(is_wrapped && first);
      if (!is_wrapped) continue;
      if (!first) first = &block;
      inner += fmt::format("{}\n          {}: {}", inner.empty() ? "" : ",", in_quotes(block.name),
                           indented(inside(block.value)));
    }
    TextChanges changes = reading_outputs();
    if (std::ranges::find(out, true) != out.end())
      std::ranges::move(without_entries(blocks, out), std::back_inserter(changes));
    changes.push_back({first->place.offset, end_of(first->value), in_quotes(name_) + ": " + block(inner)});
    return changes;
  }

 private:
  bool is_inside(const Source& source) const { return wrapped_.contains(source.block); }

  /// A block whose wires from elsewhere come from the inputs of the new diagram.
  std::string inside(const Value& block) {
    TextChanges changes;
    each_source_of_block(block, [&](const Value& wire) {
      const Source source(wire.text);
      if (!is_inside(source))
        changes.push_back(replaced(wire, in_quotes(inputs_.name_of(source) + source.element)));
    });
    std::ranges::sort(changes, {}, &TextChange::from);
    for (TextChange& change : changes) change.from -= block.place.offset, change.to -= block.place.offset;
    return applied(source_of(block), changes);
  }
  static std::string indented(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\n' ? std::string("\n      ") : std::string(1, c);
    return result;
  }

  /// What reads the blocks from outside reads the outputs of the new one. Records name what is inside.
  TextChanges reading_outputs() {
    TextChanges changes;
    const auto read_output = [&](const Value& wire) {
      const Source source(wire.text);
      if (is_inside(source))
        changes.push_back(replaced(wire, in_quotes(name_ + "." + outputs_.name_of(source) + source.element)));
    };
    for (const Value::Member& block : level_.blocks().members)
      if (!wrapped_.contains(block.name)) each_source_of_block(block.value, read_output);
    each_source_of_outputs(*level_.diagram, read_output);
    const auto keep_inside = [&](const Value& signal) {
      if (is_inside(Source(signal.text)))
        changes.push_back(replaced(signal, in_quotes(name_ + "." + signal.text)));
    };
    each_recorded(*level_.diagram, keep_inside);
    each_in_figures(*level_.diagram, keep_inside);
    return changes;
  }

  std::string block(const std::string& inner) const {
    const auto [own_parameters, passed] = parameters();
    std::string in, ports;
    for (const auto& [source, name] : inputs_.names()) {
      in += fmt::format("{}{}: {}", in.empty() ? "" : ", ", in_quotes(name), in_quotes(source));
      ports += fmt::format("{}{}: {}", ports.empty() ? "" : ", ", in_quotes(name), declared_input(source));
    }
    std::string read;
    for (const auto& [source, name] : outputs_.names())
      read += fmt::format("{}{}: {}", read.empty() ? "" : ", ", in_quotes(name), in_quotes(source));
    std::string text = "{\n      \"diagram\": {";
    if (!own_parameters.empty()) text += "\n        \"parameters\": {" + own_parameters + "},";
    if (!ports.empty()) text += "\n        \"inputs\": {" + ports + "},";
    text += "\n        \"blocks\": {" + inner + "\n        }";
    if (!read.empty()) text += ",\n        \"outputs\": {" + read + "}";
    text += "\n      }";
    if (!passed.empty()) text += ",\n      \"parameters\": {" + passed + "}";
    if (!in.empty()) text += ",\n      \"in\": {" + in + "}";
    return text + "\n    }";
  }
  /// As this diagram declares its own input; without a unit, that of the wire.
  std::string declared_input(const std::string& source) const {
    const Value::Member* inputs = level_.diagram->find("inputs");
    const Value::Member* own = inputs ? inputs->value.find(source) : nullptr;
    return own ? std::string(source_of(own->value)) : "\"\"";
  }
  /// Parameters that the blocks use, as they are here, and how they are passed on.
  std::pair<std::string, std::string> parameters() const {
    const Value::Member* all = level_.diagram->find("parameters");
    if (!all) return {};
    std::set<std::string> words;
    for (const std::string& name : wrapped_) add_words(level_.block(name)->value, words);
    for (size_t before = 0; before != words.size();) {  // what these are computed from, too
      before = words.size();
      for (const Value::Member& parameter : all->value.members)
        if (words.contains(parameter.name)) add_words(parameter.value, words);
    }
    std::string own, passed;
    for (const Value::Member& parameter : all->value.members) {
      if (!words.contains(parameter.name)) continue;
      const char* const comma = own.empty() ? "" : ", ";
      own += fmt::format("{}{}: {}", comma, in_quotes(parameter.name), source_of(parameter.value));
      passed += fmt::format("{}{}: {}", comma, in_quotes(parameter.name), in_quotes("=" + parameter.name));
    }
    return {own, passed};
  }

  const Level& level_;
  const std::set<std::string> wrapped_;
  const std::string name_;
  PortNames inputs_, outputs_{{}};
};

}  // namespace

bool apply_wrap_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects) {
  if (required_text(intent, "intent") != "wrap") return false;
  const Level level = draft.level(context.inside);
  const std::vector<std::string> names = required_texts(intent, "blocks");
  if (names.empty()) throw Refused("no block is named");
  std::string name(text_in(intent, "name"));
  if (name.empty())
    name = free_name(level, "subdiagram");
  else
    require_free_name(level, name);
  TextChanges changes = Wrapping(level, names, name).changes();
  for (const std::string& wrapped : names) {
    std::ranges::move(renamed_in_outer_diagrams(level, wrapped, name + "." + wrapped),
                      std::back_inserter(changes));
    effects.renamed.push_back(
        {Renaming::Kind::block, joined(level.inside, wrapped), joined(joined(level.inside, name), wrapped)});
  }
  effects.blocks.push_back(joined(level.inside, name));
  effects.what =
      names.size() == 1 ? fmt::format("wrap {}", names.front()) : fmt::format("wrap {} blocks", names.size());
  draft.change(std::move(changes));
  return true;
}

}  // namespace loopwright::studio
