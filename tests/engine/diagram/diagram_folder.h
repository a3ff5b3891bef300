/// A folder of small diagram files that lives as long as a test.
#pragma once
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unistd.h>
#include <gtest/gtest.h>
#include "engine/diagram/diagram.h"

namespace loopwright {

class DiagramFolder {
 public:
  DiagramFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "loopwright_diagram_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~DiagramFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  DiagramFolder(const DiagramFolder&) = delete;
  DiagramFolder& operator=(const DiagramFolder&) = delete;

  DiagramFolder& with(const std::string& name, std::string_view text) {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::filesystem::remove(path_ / name);  // some file systems flush a file that is overwritten
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this;
  }
  std::string path(const std::string& name) const { return (path_ / name).string(); }

  /// The diagram. Fails the test if it has problems.
  std::shared_ptr<const Diagram> load(const std::string& name = "top.json",
                                      const LoadOptions& options = {}) const {
    Problems problems;
    auto diagram = load_diagram(path(name), options, problems);
    EXPECT_EQ(problems.text(), "");
    if (!diagram) throw std::runtime_error("the diagram was not loaded");
    return diagram;
  }

  /// Every problem as text, with file names relative to the folder.
  std::string problems(const std::string& name = "top.json", const LoadOptions& options = {}) const {
    Problems problems;
    load_diagram(path(name), options, problems);
    std::string text = problems.text();
    const std::string folder = path_.string() + "/";
    for (size_t at = text.find(folder); at != text.npos; at = text.find(folder))
      text.erase(at, folder.size());
    return text;
  }

 private:
  std::filesystem::path path_;
};

inline const BlockEntry& block_of(const Diagram& diagram, std::string_view name) {
  for (const BlockEntry& block : diagram.blocks)
    if (block.name == name) return block;
  throw std::runtime_error("no block " + std::string(name));
}

inline const Value& setting_of(const Diagram& diagram, std::string_view block, std::string_view setting) {
  const auto* member = block_of(diagram, block).settings.find(setting);
  if (!member) throw std::runtime_error("no setting " + std::string(setting));
  return member->value;
}

inline const Parameter& parameter_of(const Diagram& diagram, std::string_view name) {
  for (const Parameter& parameter : diagram.parameters)
    if (parameter.name == name) return parameter;
  throw std::runtime_error("no parameter " + std::string(name));
}

inline std::string source_of(const BlockEntry& block, std::string_view port, size_t i = 0) {
  for (const PortWires& wires : block.in)
    if (wires.port == port) return wires.wires.at(i).source;
  return "";
}

}  // namespace loopwright
