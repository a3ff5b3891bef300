#include "tools/diagnose/predict/site.h"
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include "tools/diagnose/predict/block_value.h"

namespace loopwright::diagnosis {
namespace {

BlockEntry block_of_type(std::string type, std::string name, const Place& place) {
  BlockEntry block;
  block.name = std::move(name), block.type = std::move(type);
  block.place = block.type_place = block.settings.place = place;
  block.settings.kind = Value::Kind::object;
  return block;
}

/// One diagram of the nest; a site lies in the diagram of its block.
class Rewriter {
 public:
  Rewriter(const Diagram& diagram, std::string prefix, const Plan& plan, std::vector<Site>& sites)
      : original_(diagram),
        copy_(std::make_shared<Diagram>(diagram)),
        prefix_(std::move(prefix)),
        plan_(plan),
        sites_(sites) {}

  std::shared_ptr<const Diagram> run() {
    for (const BlockEntry& block : original_.blocks)
      if (!block.subdiagram) look_at(block);
    for (BlockEntry& block : copy_->blocks)
      if (block.subdiagram)
        block.subdiagram = Rewriter(*block.subdiagram, prefix_ + block.name + ".", plan_, sites_).run();
    std::ranges::move(added_, std::back_inserter(copy_->blocks));
    return copy_;
  }

 private:
  void look_at(const BlockEntry& block) {
    if (block.type == "Sum") {
      if (is_scalar(block.name + ".sum")) at_sum(block);
      return;
    }
    const BlockType* type = find_block(block.type);
    if (!type) return;
    const bool has_states = type->info.fixed_states > 0 || type->info.state_vectors > 0;
    for (const PortInfo& output : type->info.outputs) {
      const std::string port = block.name + "." + std::string(output.name);
      if (!is_scalar(port)) continue;
      if (block.name.starts_with("recorded_"))
        after(block, port, Site::Kind::input);
      else if (sums_that_read(port) > 1 && output.state < 0 && !type->info.inputs.empty())
        after(block, port, Site::Kind::shared);
      else if (has_states && type->info.outputs.size() == 1 && is_filter(block) && !readers_of(port).empty())
        after(block, port, Site::Kind::block);
    }
    if (!has_states) return;
    for (const PortInfo& input : type->info.inputs) at_input(block, input);
  }

  /// A block that passes on what it is fed: its output is in the unit of its input.
  bool is_filter(const BlockEntry& block) const {
    const std::vector<Number> in = plan_.find(prefix_ + block.name + ".u"),
                              out = plan_.find(prefix_ + block.name + ".y");
    return in.size() == 1 && out.size() == 1 && block.type != "Integrator";
  }
  bool is_scalar(const std::string& port) const { return plan_.find(prefix_ + port).size() == 1; }

  size_t sums_that_read(const std::string& port) const {
    const std::vector<const BlockEntry*> readers = readers_of(port);
    return size_t(std::ranges::count(readers, std::string("Sum"), &BlockEntry::type));
  }

  BlockEntry& copy_of(const std::string& name) const {
    return *std::ranges::find(copy_->blocks, name, &BlockEntry::name);
  }
  /// The block that provides the term at a new site; its output is "y". `own`: the full path of the port that
  /// is distorted.
  std::string provide(Site::Kind kind, const std::string& port, std::string own, const Place& place) {
    Site site;
    site.kind = kind, site.name = prefix_ + port, site.own_signal = std::move(own);
    const std::string name = fmt::format("term at {}", sites_.size());  // no block of a file has a space
    site.term_block = prefix_ + name;
    if (const std::vector<Number> numbers = plan_.find(site.name); numbers.size() == 1)
      site.unit = plan_.unit_of(numbers[0]);
    site.quantity = quantity_of(site.unit);
    sites_.push_back(std::move(site));
    added_.push_back(block_of_type("ExternalSignal", name, place));
    return name + ".y";
  }

  /// The blocks of this diagram that read the port, each once.
  std::vector<const BlockEntry*> readers_of(const std::string& port) const {
    std::vector<const BlockEntry*> list;
    for (const BlockEntry& block : original_.blocks)
      if (std::ranges::any_of(block.in, [&](const PortWires& in) {
            return std::ranges::find(in.wires, port, &Wire::source) != in.wires.end();
          }))
        list.push_back(&block);
    return list;
  }
  /// Whether a term at the port is one at a later Sum, but for a factor.
  bool leads_to_sum(const std::string& port) const {
    const std::vector<const BlockEntry*> readers = readers_of(port);
    if (readers.size() != 1) return false;
    if (readers[0]->type == "Sum") return true;
    if (readers[0]->type != "Gain") return false;
    const std::string behind = readers[0]->name + ".y";
    return sums_that_read(behind) > 1 || leads_to_sum(behind);
  }
  /// The number that gains, one after the other, multiply.
  Number before_gains(Number number) const {
    for (;;) {
      const int source = plan_.source_of(number).first;
      if (source < 0 || plan_.blocks[size_t(source)].type->info.type != "Gain") return number;
      number = plan_.blocks[size_t(source)].inputs[0][0];
    }
  }

  void at_sum(const BlockEntry& block) {
    if (leads_to_sum(block.name + ".sum")) return;
    BlockEntry& sum = copy_of(block.name);
    const auto terms = std::ranges::find(sum.in, "terms", &PortWires::port);
    if (terms == sum.in.end()) return;
    const std::string wire = provide(Site::Kind::sum, block.name + ".sum", "", block.place);
    const Value::Member* signs = sum.settings.find("signs");
    if (signs && !signs->value.text.empty())
      set_member(sum.settings, "signs", text_value(signs->value.text + "+"));
    terms->is_list = true;
    terms->wires.push_back({wire, terms->place});
  }

  /// A Sum of two wires; returns its output.
  std::string sum_of(const std::string& port, const std::string& term, const Place& place) {
    BlockEntry sum = block_of_type("Sum", "sum " + term.substr(0, term.find('.')), place);
    sum.in.push_back({"terms", place, true, {{port, place}, {term, place}}});
    added_.push_back(std::move(sum));
    return added_.back().name + ".sum";
  }

  /// All readers of the port read the port plus the term.
  void after(const BlockEntry& block, const std::string& port, Site::Kind kind) {
    const std::string sum = sum_of(port, provide(kind, port, prefix_ + port, block.place), block.place);
    const auto redirect = [&](Wire& wire) {
      if (wire.source == port) wire.source = sum;
    };
    const auto redirect_of = [&](BlockEntry& reader) {
      for (PortWires& in : reader.in) std::ranges::for_each(in.wires, redirect);
    };
    std::ranges::for_each(copy_->blocks, redirect_of);
    std::for_each(added_.begin(), added_.end() - 1, redirect_of);  // sites before inputs, but not the new sum
    for (DiagramOutput& output : copy_->outputs) redirect(output.source);
  }

  /// The input of a block with states, if no other site covers it: neither a Sum feeds it nor a state, whose
  /// wire is kinematics, nor a port that is a site itself; nor does a recorded input enter a filter there.
  void at_input(const BlockEntry& block, const PortInfo& input) {
    BlockEntry& reader = copy_of(block.name);
    const auto port = std::ranges::find(reader.in, input.name, &PortWires::port);
    const std::string name = block.name + "." + std::string(input.name);
    if (port == reader.in.end()) {  // an unwired force, such as that on the load of a TwoMass
      if (!input.is_optional || input.unit != "$force") return;
      const std::string wire = provide(Site::Kind::wire, name, "", block.place);
      reader.in.push_back({std::string(input.name), block.place, false, {{wire, block.place}}});
      return;
    }
    if (port->wires.size() != 1 || !is_scalar(name)) return;
    const Number number = plan_.find(prefix_ + name).front();
    const int source = plan_.source_of(before_gains(number)).first;
    if (source < 0 || number >= plan_.signals) return;
    const std::string& type = plan_.blocks[size_t(source)].type->info.type;
    const std::string& path = plan_.blocks[size_t(source)].path;
    const bool is_driven = path.starts_with("recorded_");
    if (type == "Sum" || (is_driven && is_filter(block))) return;
    const std::string own = port->wires[0].source;
    if (!is_driven && own.starts_with("sum term at ")) return;  // the source is a site
    // Distortions of what is recorded have their site where it enters: here is what depends on other signals.
    const std::string term =
        provide(Site::Kind::wire, name, is_driven ? "" : plan_.name_of(number), block.place);
    port->wires[0].source = sum_of(own, term, block.place);
  }

  const Diagram& original_;
  std::shared_ptr<Diagram> copy_;
  const std::string prefix_;
  const Plan& plan_;
  std::vector<Site>& sites_;
  std::vector<BlockEntry> added_;
};

}  // namespace

std::shared_ptr<const Diagram> with_sites(const Diagram& diagram, const Plan& plan,
                                          std::vector<Site>& sites) {
  return Rewriter(diagram, "", plan, sites).run();
}

}  // namespace loopwright::diagnosis
