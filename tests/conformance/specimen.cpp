#include "tests/conformance/specimen.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include "engine/diagram/diagram.h"
#include "engine/json/json.h"
#include "engine/plan/block_settings.h"
#include "where.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;

/// A test bench has no folder: texts that name a file beside the diagram become absolute paths.
Value with_whole_paths(Value settings) {
  for (Value::Member& member : settings.members)
    if (member.value.kind == Value::Kind::text && !member.value.text.empty())
      if (const std::string path = resolve_relative(member.value.place, member.value.text);
          fs::is_regular_file(path))
        member.value.text = path;
  return settings;
}

/// The number of elements of each input of the block. A vector output that feeds it counts with its length.
std::vector<int> wires_of(const BlockEntry& entry, const Diagram& diagram, const BlockInfo& info) {
  std::vector<int> wires;
  for (const PortInfo& input : info.inputs) {
    if (input.shape == PortInfo::Shape::named) {
      const auto is_named = [&](const PortWires& port) {
        return std::ranges::none_of(
            info.inputs, [&](const PortInfo& other) { return &other != &input && other.name == port.port; });
      };
      const auto named = std::ranges::count_if(entry.in, is_named);
      wires.insert(wires.end(), size_t(named), 1);
      continue;
    }
    int count = input.shape == PortInfo::Shape::scalar ? 1 : 0;
    for (const PortWires& port : entry.in)
      if (port.port == input.name && input.shape == PortInfo::Shape::many) count = int(port.wires.size());
    // In the examples a vector comes from a Pack and has its number of elements.
    for (const PortWires& port : entry.in)
      for (const BlockEntry& source : diagram.blocks)
        if (port.port == input.name && input.shape == PortInfo::Shape::vector && !port.wires.empty() &&
            port.wires[0].source == source.name + ".y" && source.type == "Pack" && !source.in.empty())
          count = int(source.in[0].wires.size());
    wires.push_back(count);
  }
  return wires;
}

/// Cases that the diagrams do not cover: systems without direct feedthrough, tables far from zero, starts and
/// ends outside a short test.
const Specimen further[] = {
    {"StateSpace",
     "with direct feedthrough",
     R"({"A": [[-1, 2], [0, -3]], "B": [[1, 0], [2, 1]], "C": [[1, 1]], "D": [[2, 3]]})",
     0,
     {2}},
    {"DiscreteStateSpace",
     "with direct feedthrough",
     R"({"A": [[0.5]], "B": [[1, 2]], "C": [[1], [2]], "D": [[2, 3], [0, 1]]})",
     0.001,
     {2}},
    {"Lookup2D",
     "about zero",
     R"({"rows": [-10, 0, 1, 20], "columns": [-10, 0, 10], "values": [[1, 2, 4], [8, 16, 32], [5, 3, 2], [1, 7, 6]]})",
     0,
     {1, 1}},
    {"DiscreteIntegrator",
     "of the present input",
     R"({"method": "backward", "low": -3, "high": 5})",
     0.001,
     {1, 1, 1}},
    {"ElectronicGear", "without a ramp", R"({"numerator": 2})", 0.001, {1, 1, 1, 1}},
    {"RepetitiveController", "of a short period", R"({"period": 3, "gain": 1})", 0.001, {1, 1}},
    {"FractionalDelay", "of less than a sample", R"({"delay": 0.0004})", 0.001, {1}},
    {"Chirp",
     "of short sweeps",
     R"({"from": 0, "to": 30, "duration": 0.25, "start": 0.1, "repeats": true, "phase": 1})",
     0,
     {}},
};

using Collection = std::map<std::string, std::vector<Specimen>, std::less<>>;

void collect(const Diagram& diagram, const std::string& prefix, Collection& to) {
  for (const BlockEntry& entry : diagram.blocks) {
    if (entry.subdiagram) collect(*entry.subdiagram, prefix + entry.name + ".", to);
    const BlockType* type = find_block(entry.type);
    if (!type) continue;
    // As when a plan is made: with the parameters in a formula, and of a vector the first element.
    const auto extended = settings_with_constants(type->info, entry.settings, diagram.parameters);
    Value settings = extended ? *extended : entry.settings;
    Problems problems;
    if (auto elements = settings_by_element(type->info, settings, entry.name, problems); !elements.empty())
      settings = std::move(elements[0]);
    Specimen specimen{entry.type, prefix + entry.name, to_json(with_whole_paths(std::move(settings))),
                      entry.sample_time ? entry.sample_time->number : 0,
                      wires_of(entry, diagram, type->info)};
    auto& list = to[entry.type];
    const bool is_known = std::ranges::any_of(list, [&](const Specimen& s) {
      return s.settings == specimen.settings && s.sample_time == specimen.sample_time &&
             s.wires == specimen.wires;
    });
    if (!is_known) list.push_back(std::move(specimen));
  }
}

/// ds.json beside ds.model.json: the same blocks as in others, but slow to load.
bool has_large_model(const fs::path& diagram) {
  return diagram.parent_path().filename() != "examples" &&
         fs::exists(fs::path(diagram).replace_extension(".model.json"));
}

Collection collect_all() {
  Collection all;
  std::vector<fs::path> files;
  for (const auto& file : fs::recursive_directory_iterator(fs::path(LOOPWRIGHT_SOURCE) / "diagrams"))
    if (file.path().extension() == ".json" && !file.path().stem().has_extension() &&
        !has_large_model(file.path()) &&
        file.path().parent_path().filename() != "effects")  // fragments, tested in tests/tools/effects
      files.push_back(file.path());
  std::ranges::sort(files);  // examples come before larger diagrams with the same blocks
  for (const fs::path& file : files) {
    Problems problems;
    if (const auto diagram = load_diagram(file.string(), {}, problems))
      collect(*diagram, file.filename().string() + ": ", all);
  }
  for (const Specimen& specimen : further) all[specimen.type].push_back(specimen);
  for (auto& [type, list] : all)  // one with the same ports in every test
    if (find_block(type)->info.input_ports) list.resize(1);
  return all;
}

}  // namespace

const std::vector<Specimen>& specimens_of(std::string_view type) {
  static const Collection all = collect_all();
  static const std::vector<Specimen> none;
  const auto found = all.find(type);
  return found == all.end() ? none : found->second;
}

const BlockInfo& info_of_specimen(const std::string& type) {
  const BlockInfo& info = find_block(type)->info;
  if (!info.input_ports && !info.output_ports) return info;
  static std::map<std::string, std::unique_ptr<BlockUnderTest>> benches;
  auto& block = benches[type];
  if (!block) block = bench(specimens_of(type).front());
  return block->info();
}

std::unique_ptr<BlockUnderTest> bench(const Specimen& specimen) {
  auto block = std::make_unique<BlockUnderTest>(specimen.type, specimen.settings, specimen.sample_time);
  if (block->problems().has_errors())
    throw std::runtime_error(specimen.where + ":\n" + block->problems().text());
  const auto& inputs = block->info().inputs;
  for (size_t i = 0; i < inputs.size(); ++i) {
    auto& numbers = block->inputs(inputs[i].name);
    if (numbers.empty()) numbers.assign(size_t(std::max(1, specimen.wires[i])), inputs[i].otherwise_value);
  }
  return block;
}

double random_number(std::mt19937_64& random) {
  if (random() % 8 == 0) return 0;
  const double exponent = std::uniform_real_distribution(-3.0, 2.0)(random);
  return (random() % 2 ? 1 : -1) * std::pow(10.0, exponent);
}

void randomize_inputs(BlockUnderTest& block, std::mt19937_64& random) {
  for (const PortInfo& port : block.info().inputs)
    for (double& number : block.inputs(port.name)) number = random_number(random);
}

double time_of_step(const Specimen& specimen, int step) {
  return step * (specimen.sample_time > 0 ? specimen.sample_time : 1e-3);
}

bool random_step(BlockUnderTest& block, const Specimen& specimen, int step, std::mt19937_64& random) {
  randomize_inputs(block, random);
  for (double& state : block.states()) state += 0.1 * random_number(random);
  block.evaluate(time_of_step(specimen, step), step);
  block.derivatives();
  block.crossings();
  block.jump();
  block.update();
  block.accept();
  return block.fault().empty();
}

std::vector<double> all_outputs(const BlockUnderTest& block) {
  std::vector<double> all;
  for (const PortInfo& port : block.info().outputs) {
    const auto& numbers = block.outputs(port.name);
    all.insert(all.end(), numbers.begin(), numbers.end());
  }
  return all;
}

bool equal_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

}  // namespace loopwright
