#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <span>
#include <unordered_map>
#include "engine/diagram/diagram.h"
#include "engine/diagram/drive.h"
#include "engine/diagram/edit.h"
#include "engine/diagram/in_memory.h"
#include "engine/diagram/library.h"
#include "engine/diagram/parameters.h"
#include "engine/diagram/ports.h"
#include "engine/diagram/reader.h"
#include "engine/diagram/solver_settings.h"
#include "engine/diagram/variants.h"
#include "engine/diagram/wires.h"

namespace loopwright {
namespace {

constexpr size_t deepest_nesting = 32;   // subdiagrams in subdiagrams
constexpr size_t most_blocks = 200'000;  // a few small files can name each other into billions

/// One use of a diagram file: what its surroundings ask of it.
struct Instance {
  std::string block;  // path of the subdiagram block; empty at the top
  std::vector<Override> overrides;
  std::vector<Edit> edits;
  std::vector<VariantChoice> variants;
};

class DiagramReader;

/// What all diagrams of one load share.
struct Nest {
  Problems& problems;
  DiagramLibrary library{problems};
  std::vector<std::string> opened{};      // the files being read, outermost first
  std::vector<std::string> identities{};  // of the same
  size_t blocks = 0;

  std::shared_ptr<Diagram> load(const std::string& path, const Place& reference, Instance instance);
  /// A diagram that stands in the file at `path` where others name a file.
  std::shared_ptr<Diagram> read(const Value& root, const std::string& path, Instance instance);
};

/// Reads one use of a diagram file.
class DiagramReader {
 public:
  DiagramReader(Nest& nest, Instance instance, std::string path)
      : nest_(nest),
        instance_(std::move(instance)),
        path_(std::move(path)),
        reader_{nest.problems, instance_.block},
        scope_(instance_.block, nest.problems) {}

  std::shared_ptr<Diagram> read(const Value& root) {
    diagram_->path = path_;
    diagram_->title = reader_.text(root, "title");
    diagram_->description = reader_.text(root, "description");
    reader_.reject_unknown(
        root,
        {"loopwright", "title", "description", "parameters", "solver", "blocks", "inputs", "outputs", "log"},
        "a diagram");
    read_parameters(root);
    read_solver(root);
    read_blocks(root);
    diagram_->inputs = read_inputs_of_diagram(root, reader_);
    diagram_->outputs = read_outputs_of_diagram(root, reader_);
    if (const auto* log = root.find("log")) diagram_->log = read_log(log->value, reader_);
    report_unused_options();
    diagram_->parameters = scope_.take_parameters();
    return diagram_;
  }

 private:
  // ---- Parameters and solver ----

  void read_parameters(const Value& root) {
    if (const auto* parameters = root.find("parameters")) scope_.declare(parameters->value);
    for (Override& replacement : instance_.overrides) scope_.override_with(std::move(replacement));
    const auto* blocks = root.find("blocks");
    std::erase_if(instance_.edits, [&](const Edit& edit) {
      const bool is_block = blocks && blocks->value.find(edit.head());
      if (!scope_.declares(edit.head()) || (is_block && !edit.is_last())) return false;
      scope_.override_with(
          {edit.head(), edit.value.place, edited(scope_.given_value(edit.head()), edit.inside())});
      return true;
    });
    scope_.resolve();
  }

  Value edited(Value value, const Edit& edit) const {
    apply_edit(edit, value, reader_);
    return value;
  }

  bool is_top() const { return instance_.block.empty(); }

  void read_solver(const Value& root) {
    const auto* written = root.find("solver");
    Value solver = written ? written->value : Value{};
    if (!written) {
      solver.kind = Value::Kind::object;
      solver.place = root.place;
    }
    if (is_top()) {
      std::erase_if(instance_.edits, [&](const Edit& edit) {
        if (edit.head() != "solver" || edit.is_last()) return false;
        apply_edit(edit.inside(), solver, reader_);
        return true;
      });
    }
    diagram_->solver = read_solver_settings(solver, scope_, reader_);
  }

  // ---- Blocks ----

  void read_blocks(const Value& root) {
    const auto* blocks = root.find("blocks");
    if (!blocks || !reader_.expect(blocks->value, Value::Kind::object, "\"blocks\"",
                                   "an object: {\"name\": {\"type\": …}}"))
      return;
    const std::span members(blocks->value.members);
    diagram_->blocks.reserve(members.size());
    for (const Value::Member& member : members) {
      if (++nest_.blocks > most_blocks) {
        if (nest_.blocks == most_blocks + 1)
          reader_.error(member, fmt::format("the diagram has more than {} blocks", most_blocks));
        return;
      }
      blocks_read_ = members.first(blocks_read_.size() + 1);
      read_block(member);
    }
  }

  void read_block(const Value::Member& member) {
    if (!reader_.check_name(member, "a block")) return;
    BlockEntry& entry = diagram_->blocks.emplace_back();
    entry.name = member.name;
    entry.place = member.place;
    entry.settings.kind = Value::Kind::object;
    entry.settings.place = member.value.place;

    const Reader reader{nest_.problems, joined(instance_.block, member.name)};
    auto edits = take_options(instance_.edits, member.name);
    auto variants = take_options(instance_.variants, member.name);
    if (!reader.expect(member.value, Value::Kind::object, "a block", "an object: {\"type\": …, \"in\": {…}}"))
      return;
    if (const auto* in = member.value.find("in")) entry.in = read_inputs(in->value, reader);

    const Value* body = &member.value;
    const bool has_variants = member.value.find("variants") != nullptr;
    if (has_variants)
      body = active_variant(member.value, entry, variants, reader);
    else
      reject_choices(variants, reader);
    if (!body) return;

    Value copy;
    const bool is_subdiagram = body->find("diagram") != nullptr;
    if (!edits.empty() && !is_subdiagram) {
      copy = *body;
      for (const Edit& edit : edits) edit_settings(edit, copy, reader);
      body = &copy;
    }
    if (is_subdiagram)
      read_subdiagram(*body, entry, std::move(edits), std::move(variants), has_variants, reader);
    else
      read_ordinary(*body, entry, std::move(variants), has_variants, reader);
  }

  /// The options whose path leads through a block, as they look from inside it.
  template <class Option>
  static std::vector<Option> take_options(std::vector<Option>& options, const std::string& block) {
    std::vector<Option> taken;
    std::erase_if(options, [&](const Option& option) {
      if (option.path[option.depth] != block) return false;
      taken.push_back(option);
      ++taken.back().depth;
      return true;
    });
    return taken;
  }

  void edit_settings(const Edit& edit, Value& body, const Reader& reader) const {
    constexpr std::array reserved = {"type",     "in",      "diagram",    "parameters",
                                     "variants", "variant", "description"};
    const bool names_setting = edit.depth < edit.path.size();
    if (names_setting && std::ranges::find(reserved, edit.head()) == reserved.end())
      return apply_edit(edit, body, reader);
    Problem& problem = reader.error(edit.value, fmt::format("\"{}\" cannot be set", edit.text()));
    problem.expected = "the path of a parameter, or of a setting of a block";
    if (names_setting && edit.head() == "variant") problem.hint = "--variant chooses a variant";
  }

  void read_ordinary(const Value& body, BlockEntry& entry, std::vector<VariantChoice> deeper, bool is_variant,
                     const Reader& reader) {
    for (const VariantChoice& choice : deeper) {
      const std::string message = fmt::format("the block \"{}\" is not a subdiagram", reader.block);
      reader.problems.error(choice.place, {}, reader.block, message);
    }
    constexpr std::array<std::string_view, 5> engine_keys = {"type", "in", "sample_time", "sample_offset",
                                                             "description"};
    const auto is_setting = [&](const Value::Member& member) {
      return std::ranges::find(engine_keys, member.name) == engine_keys.end();
    };
    entry.settings.members.reserve(size_t(std::ranges::count_if(body.members, is_setting)));
    for (const Value::Member& member : body.members) {
      if (is_misplaced_key(member, is_variant, reader) || !is_setting(member)) continue;
      entry.settings.members.push_back(
          {member.name, member.place, scope_.evaluate(member.value, reader.block)});
    }
    entry.settings.place = body.place;
    reader.text(body, "description");
    if (const auto* time = body.find("sample_time"))
      entry.sample_time = read_time(time->value, "sample_time", scope_, reader);
    if (const auto* offset = body.find("sample_offset"))
      entry.sample_offset = read_time(offset->value, "sample_offset", scope_, reader);
    read_type(body, entry, reader);
  }

  /// Keys of the engine that are of no use where they stand.
  bool is_misplaced_key(const Value::Member& member, bool is_variant, const Reader& reader) const {
    if (member.name == "parameters") {
      reader.error(member, "only a subdiagram has \"parameters\"").hint =
          "settings of a block stand directly in its object";
      return true;
    }
    if (member.name == "variants" || member.name == "variant") {
      reader.error(member, is_variant ? "variants cannot stand inside a variant"
                                      : "\"variant\" chooses among \"variants\", which are missing");
      return true;
    }
    if (member.name == "in" && is_variant) {
      reader.error(member, "a variant cannot have its own wires").hint =
          "\"in\" stands beside \"variants\", for all of them";
      return true;
    }
    return false;
  }

  void read_type(const Value& body, BlockEntry& entry, const Reader& reader) const {
    const auto* type = body.find("type");
    if (!type) {
      Problem& problem = reader.error(body, "the block has neither \"type\" nor \"diagram\"");
      for (const Value::Member& member : body.members)
        if (const std::string near = nearest_name(member.name, {"type", "diagram", "variants"});
            !near.empty())
          problem.hint = fmt::format("did you mean \"{}\" for \"{}\"?", near, member.name);
      return;
    }
    if (!reader.expect(type->value, Value::Kind::text, "\"type\"", "the name of a block type in quotes"))
      return;
    entry.type_place = type->value.place;
    if (type->value.text.empty()) reader.error(type->value, "the block type is empty");
    entry.type = type->value.text;
  }

  void read_subdiagram(const Value& body, BlockEntry& entry, std::vector<Edit> edits,
                       std::vector<VariantChoice> variants, bool is_variant, const Reader& reader) {
    for (const Value::Member& member : body.members) {
      constexpr std::array known = {"diagram", "parameters", "in", "description"};
      const bool is_known = std::ranges::find(known, member.name) != known.end();
      if (is_known && !(is_variant && member.name == "in")) continue;
      if (member.name != "parameters" && is_misplaced_key(member, is_variant, reader)) continue;
      Problem& problem = reader.error(member, fmt::format("a subdiagram has no key \"{}\"", member.name));
      KnownNames({known.begin(), known.end()}).explain(problem, member.name);
      if (member.name == "type")
        problem.hint = "an entry has either \"type\" or \"diagram\"";
      else if (member.name.starts_with("sample_"))
        problem.hint = "sample times belong to the blocks inside";
      else if (problem.hint.empty())
        problem.hint = "parameters of the diagram stand in \"parameters\"";
    }
    reader.text(body, "description");
    const Value& path = body.find("diagram")->value;
    const bool is_inline = path.kind == Value::Kind::object;
    const bool has_path =
        is_inline || reader.expect(path, Value::Kind::text, "\"diagram\"",
                                   "the path of a diagram file in quotes, or a diagram in braces");

    Instance inner{reader.block, {}, {}, std::move(variants)};
    if (const auto* parameters = body.find("parameters"))
      inner.overrides = overrides(parameters->value, reader);
    for (Edit& edit : edits) {
      if (edit.depth == edit.path.size()) {
        edit_settings(edit, entry.settings, reader);
      } else {
        if (edit.is_last())
          edit.value =
              scope_.evaluate(edit.value, reader.block);  // over the names outside, as an override is
        inner.edits.push_back(std::move(edit));
      }
    }
    if (!has_path) return;
    if (is_inline) {
      entry.type_place = path.place;
      entry.subdiagram = nest_.read(path, path_, std::move(inner));
      return;
    }
    if (path.text.empty()) {
      reader.error(path, "the path of the diagram is empty");
      return;
    }
    entry.type_place = path.place;
    const std::string resolved = resolve_relative(path.place, path.text);
    entry.subdiagram = nest_.load(resolved, path.place, std::move(inner));
  }

  std::vector<Override> overrides(const Value& parameters, const Reader& reader) {
    std::vector<Override> list;
    if (!reader.expect(parameters, Value::Kind::object, "\"parameters\"", "an object of named values"))
      return list;
    for (const Value::Member& member : parameters.members)
      list.push_back({member.name, member.place, scope_.evaluate(member.value, reader.block)});
    return list;
  }

  /// `--variant` for a block that has none.
  static void reject_choices(std::vector<VariantChoice>& choices, const Reader& reader) {
    std::erase_if(choices, [&](const VariantChoice& choice) {
      if (!choice.is_here()) return false;
      const std::string message = fmt::format("the block \"{}\" has no variants", reader.block);
      reader.problems.error(choice.place, {}, reader.block, message);
      return true;
    });
  }

  // ---- Options that nothing used ----

  void report_unused_options() {
    if (instance_.edits.empty() && instance_.variants.empty()) return;
    KnownNames block_names;
    for (const Value::Member& block : blocks_read_) block_names.add(block.name);
    for (const Edit& edit : instance_.edits) {
      const bool is_solver = is_top() && edit.head() == "solver";
      Problem& problem = reader_.error(
          edit.value, is_solver ? "\"solver\" cannot be set as a whole"
                                : fmt::format("there is no parameter or block \"{}\"", edit.head()));
      KnownNames names = block_names;
      for (const std::string& name : scope_.names()) names.add(name);
      if (!is_solver) names.explain(problem, edit.head());
    }
    for (const VariantChoice& choice : instance_.variants) {
      const std::string& name = choice.path[choice.depth];
      Problem& problem = reader_.problems.error(choice.place, {}, reader_.block,
                                                fmt::format("there is no block \"{}\"", name));
      block_names.explain(problem, name);
    }
  }

  Nest& nest_;
  Instance instance_;
  std::string path_;
  Reader reader_;
  ParameterScope scope_;
  std::span<const Value::Member> blocks_read_;  // so far; in the values read
  std::shared_ptr<Diagram> diagram_ = std::make_shared<Diagram>();
};

std::shared_ptr<Diagram> Nest::load(const std::string& path, const Place& reference, Instance instance) {
  const auto fail = [&](std::string message) -> Problem& {
    return problems.error(reference, reference.pointer(), instance.block, std::move(message));
  };
  if (opened.size() == deepest_nesting) {
    fail(fmt::format("subdiagrams nest deeper than {} levels", deepest_nesting));
    return nullptr;
  }
  const std::string identity = library.identity(path);
  if (const auto first = std::ranges::find(identities, identity); first != identities.end()) {
    std::string chain;
    for (auto i = static_cast<size_t>(first - identities.begin()); i < opened.size(); ++i)
      chain += opened[i] + " → ";
    fail("a diagram contains itself").found = chain + path;
    return nullptr;
  }
  const DiagramFile& file = library.open(path, reference);
  if (file.root.kind != Value::Kind::object) return nullptr;
  opened.push_back(path);
  identities.push_back(identity);
  auto diagram = read(file.root, path, std::move(instance));
  opened.pop_back();
  identities.pop_back();
  return diagram;
}

std::shared_ptr<Diagram> Nest::read(const Value& root, const std::string& path, Instance instance) {
  return DiagramReader(*this, std::move(instance), path).read(root);
}

/// A diagram that is used many times tells the same problem only once.
void add_without_repetition(const Problems& found, Problems& problems) {
  std::set<std::tuple<const SourceFile*, uint32_t, std::string_view>> told;
  for (const Problem& problem : found.list())
    if (told.insert({problem.place.file.get(), problem.place.offset, problem.message}).second)
      problems.add(problem);
}

/// What the options ask of the outermost diagram.
Instance top_instance(const LoadOptions& options, Problems& problems) {
  Instance top;
  for (const auto& option : options.set)
    if (auto edit = read_edit(option, problems)) top.edits.push_back(std::move(*edit));
  for (const auto& [block, variant] : options.variants)
    if (auto choice = read_variant_choice(block, variant, problems))
      top.variants.push_back(std::move(*choice));
  return top;
}

/// Reads the outermost diagram by `read` and does to it what the options ask.
template <class Read>
std::shared_ptr<const Diagram> with_options(const LoadOptions& options, Problems& problems, Read&& read) {
  Problems found;
  Instance top = top_instance(options, found);
  Nest nest{found};
  const std::shared_ptr<Diagram> diagram = read(nest, std::move(top));
  if (diagram) {
    apply_drives(*diagram, options.drives, found);
    diagram->files = nest.library.take_names();
  }
  add_without_repetition(found, problems);
  return diagram;
}

}  // namespace

std::shared_ptr<const Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                            Problems& problems) {
  return with_options(options, problems,
                      [&](Nest& nest, Instance top) { return nest.load(path, {}, std::move(top)); });
}

std::shared_ptr<const Diagram> read_diagram(const Value& root, const std::string& path,
                                            const LoadOptions& options, Problems& problems) {
  return with_options(options, problems,
                      [&](Nest& nest, Instance top) { return nest.read(root, path, std::move(top)); });
}

std::string resolve_relative(const Place& place, std::string_view path) {
  const std::filesystem::path relative(path);
  if (!place.file || relative.is_absolute()) return std::string(path);
  return (std::filesystem::path(place.file->name).parent_path() / relative).lexically_normal().string();
}

}  // namespace loopwright
