// A block wired with vectors of n elements is equal to n scalar blocks, bit for bit.
#include <fmt/format.h>
#include <algorithm>
#include "engine/run/simulation.h"
#include "tests/conformance/registered.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::width_test {
namespace {

class Width : public EveryBlock {
 protected:
  bool is_element_wise() const {
    const auto is_vector = [](const PortInfo& p) {
      return p.shape == PortInfo::Shape::vector || p.joins_vectors;
    };
    return !info().inputs.empty() && std::ranges::none_of(info().inputs, is_vector) &&
           std::ranges::none_of(info().outputs, is_vector);
  }
  /// Waves about `center`; small ones for blocks that accept only some numbers, such as a logarithm.
  struct Waves {
    double center, size;
  };
  /// A diagram with the block once on vectors of `width`, and `width` times on their elements.
  std::string diagram(const Specimen& specimen, int width, const Waves& waves) const;
  std::string block(const Specimen& specimen, const std::string& name, const std::string& element) const;
};

std::string Width::block(const Specimen& specimen, const std::string& name, const std::string& source) const {
  std::string ports;
  for (size_t i = 0; i < info().inputs.size(); ++i) {
    const bool many = info().inputs[i].shape == PortInfo::Shape::many;
    std::string wires;
    for (int w = 0; w < std::max(1, specimen.wires[i]); ++w)
      wires += fmt::format("{}\"{}_{}_{}.y\"", w ? ", " : "", source, i, w);
    ports +=
        fmt::format("{}\"{}\": {}", i ? ", " : "", info().inputs[i].name, many ? "[" + wires + "]" : wires);
  }
  std::string settings = specimen.settings.substr(specimen.settings.find('{') + 1);
  settings.resize(settings.rfind('}'));
  if (settings.find(':') == std::string::npos) settings.clear();
  return fmt::format(
      ",\n\"{}\": {{\"type\": \"{}\"{}{}{}, \"in\": {{{}}}}}", name, specimen.type,
      settings.empty() ? "" : ", ", settings,
      specimen.sample_time > 0 ? fmt::format(", \"sample_time\": {}", specimen.sample_time) : "", ports);
}

std::string Width::diagram(const Specimen& specimen, int width, const Waves& waves) const {
  std::string sources, log;
  for (size_t i = 0; i < info().inputs.size(); ++i)
    for (int w = 0; w < std::max(1, specimen.wires[i]); ++w) {
      std::string elements;
      for (int k = 0; k < width; ++k) {
        sources += fmt::format(
            "\"u{}_{}_{}\": {{\"type\": \"Sine\", \"amplitude\": {}, \"bias\": {}, \"frequency\": {}, "
            "\"phase\": {}}},\n",
            k, i, w, waves.size * (0.3 + 0.7 * k + 0.1 * w), waves.center, 15 + 3 * k + 7 * double(i),
            0.4 + double(i) + k);
        elements += fmt::format("{}\"u{}_{}_{}.y\"", k ? ", " : "", k, i, w);
      }
      sources += fmt::format("\"all_{}_{}\": {{\"type\": \"Pack\", \"in\": {{\"elements\": [{}]}}}},\n", i, w,
                             elements);
    }
  std::string blocks = block(specimen, "wide", "all");
  for (int k = 0; k < width; ++k)
    blocks += block(specimen, fmt::format("narrow{}", k), fmt::format("u{}", k));
  for (const PortInfo& output : info().outputs) {
    log += fmt::format("{}\"wide.{}\"", log.empty() ? "" : ", ", output.name);
    for (int k = 0; k < width; ++k) log += fmt::format(", \"narrow{}.{}\"", k, output.name);
  }
  const double step = specimen.sample_time > 0 ? specimen.sample_time / 2 : 1e-3;
  return fmt::format(
      "{{\"loopwright\": 1, \"solver\": {{\"method\": \"rk4\", \"step\": {}, \"stop\": {}}},\n\"blocks\": "
      "{{\n{}{}}},\n\"log\": [{}]}}",
      step, 100 * step, sources, blocks.substr(2), log);
}

TEST_P(Width, OfAVectorIsSoManyScalarBlocks) {
  if (!is_element_wise()) GTEST_SKIP() << "has vector ports, or no inputs";
  for (const Specimen& specimen : specimens())
    for (int width : {1, 7}) {
      SCOPED_TRACE(specimen.where + ", " + std::to_string(width) + " wide");
      RunResult result;
      for (const Waves& waves : {Waves{0, 1}, Waves{0.5, 0.05}}) {
        DiagramFolder folder;
        const std::string text = diagram(specimen, width, waves);
        folder.with("top.json", text);
        try {
          result = simulate(*load_plan(folder.path("top.json")));
        } catch (const InputError& error) {
          FAIL() << error.what() << "\n" << text;
        }
        if (result.recording.rows() > 1) break;
      }
      const Recording& recording = result.recording;
      ASSERT_GT(recording.rows(), 1u) << result.message;
      for (const PortInfo& output : info().outputs)
        for (int k = 0; k < width; ++k) {
          const Column* wide = recording.find(width == 1 ? fmt::format("wide.{}", output.name)
                                                         : fmt::format("wide.{}[{}]", output.name, k));
          const Column* narrow = recording.find(fmt::format("narrow{}.{}", k, output.name));
          ASSERT_TRUE(wide && narrow);
          ASSERT_TRUE(equal_bits(wide->values, narrow->values)) << output.name << "[" << k << "]";
        }
    }
}
LOOPWRIGHT_FOR_EVERY_BLOCK(Width);

}  // namespace
}  // namespace loopwright::width_test
