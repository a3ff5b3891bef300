#include <algorithm>
#include <fmt/format.h>
#include "engine/diagram/block_reader.h"
#include "engine/diagram/diagram_load.h"
#include "engine/diagram/figures.h"
#include "engine/diagram/ports.h"
#include "engine/json/reader.h"
#include "engine/diagram/solver_settings.h"
#include "engine/diagram/value_file.h"
#include "engine/diagram/wires.h"

namespace loopwright {
namespace {

constexpr size_t most_blocks = 200'000;  // a few small files can name each other and give billions of blocks

/// Reads one use of a diagram file.
class DiagramReader {
 public:
  DiagramReader(DiagramLoad& load, Instance instance, std::string path, const BlockList& blocks)
      : load_(load),
        instance_(std::move(instance)),
        path_(std::move(path)),
        blocks_(blocks),
        reader_{load.problems, instance_.block},
        scope_(instance_.block, load.problems) {}

  std::shared_ptr<Diagram> read(const Value& root) {
    diagram_->path = path_;
    reader_.text(root, "$schema");
    diagram_->title = reader_.text(root, "title");
    diagram_->description = reader_.text(root, "description");
    reader_.reject_unknown(root,
                           {"$schema", "loopwright", "title", "description", "parameters", "solver", "blocks",
                            "inputs", "outputs", "log", "figures"},
                           "a diagram");
    read_parameters(root);
    read_solver(root);
    read_blocks(root);
    diagram_->inputs = read_inputs_of_diagram(root, reader_);
    diagram_->outputs = read_outputs_of_diagram(root, reader_);
    if (const auto* log = root.find("log")) diagram_->log = read_log(log->value, reader_);
    if (const auto* figures = root.find("figures")) read_figures(figures->value, reader_);
    report_unused_options();
    diagram_->parameters = scope_.take_parameters();
    return diagram_;
  }

 private:
  // ---- Parameters and solver ----

  void read_parameters(const Value& root) {
    if (const auto* parameters = root.find("parameters")) scope_.declare(parameters->value);
    for (Override& replacement : instance_.overrides) scope_.override_with(std::move(replacement));
    std::erase_if(instance_.edits, [&](const Edit& edit) {
      if (!scope_.declares(edit.head()) || (is_block(edit.head()) && !edit.is_last())) return false;
      scope_.override_with(
          {edit.head(), edit.value.place, edited(scope_.given_value(edit.head()), edit.inside())});
      return true;
    });
    scope_.resolve();
  }

  bool is_block(std::string_view name) const {
    bool found = false;
    blocks_.each_name([&](std::string_view block) { found |= block == name; });
    return found;
  }

  Value edited(Value value, const Edit& edit) const {
    apply_edit(edit, value, reader_, [&](Value& at) { take_from_file(at, reader_); });
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
    diagram_->blocks.reserve(blocks_.size());
    blocks_.each([&](const Value::Member& member) {
      if (++load_.block_count > most_blocks) {
        if (load_.block_count == most_blocks + 1)
          reader_.error(member, fmt::format("the diagram has more than {} blocks", most_blocks));
        return false;
      }
      ++blocks_read_;
      add_block(member);
      return true;
    });
  }

  void add_block(const Value::Member& member) {
    if (!reader_.check_name(member, "a block")) return;
    BlockEntry& entry = diagram_->blocks.emplace_back();
    entry.name = member.name;
    entry.place = member.place;
    entry.settings.kind = Value::Kind::object;
    entry.settings.place = member.value.place;

    const Reader reader{load_.problems, joined(instance_.block, member.name)};
    auto edits = take_options(instance_.edits, member.name);
    auto variants = take_options(instance_.variants, member.name);
    read_block(member, std::move(edits), std::move(variants), {load_, scope_, path_}, reader, entry);
  }

  /// The options whose path leads through a block, as seen from inside it.
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

  // ---- Unused options ----

  void report_unused_options() {
    if (instance_.edits.empty() && instance_.variants.empty()) return;
    KnownNames block_names;
    blocks_.each_name([&, left = blocks_read_](std::string_view name) mutable {
      if (left > 0) block_names.add(std::string(name)), --left;
    });
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

  DiagramLoad& load_;
  Instance instance_;
  const std::string path_;
  const BlockList& blocks_;
  Reader reader_;
  ParameterScope scope_;
  size_t blocks_read_ = 0;
  std::shared_ptr<Diagram> diagram_ = std::make_shared<Diagram>();
};

}  // namespace

std::shared_ptr<Diagram> DiagramLoad::read(const Value& root, const BlockList& blocks,
                                           const std::string& path, Instance instance) {
  return DiagramReader(*this, std::move(instance), path, blocks).read(root);
}

}  // namespace loopwright
