// The reference agrees with the descriptions of the blocks, and every block has a test, an example, texts and
// units.
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include "engine/block/instance_ports.h"
#include "engine/block/registry.h"
#include "engine/unit/unit.h"
#include "tools/reference/reference.h"
#include "where.h"

namespace loopwright::reference_test {
namespace {

namespace fs = std::filesystem;
const fs::path root = LOOPWRIGHT_SOURCE;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Reference, ThePageInDocsIsWhatTheProgramWrites) {
  EXPECT_EQ(text_of(root / "docs/blocks.md"), block_reference(root / "docs/images/blocks"))
      << "loopwright blocks --markdown --pictures docs/images/blocks > docs/blocks.md";
}

TEST(Reference, EveryTypeStandsInTheListThePageAndItsOwnText) {
  const std::string list = block_list(), page = block_reference();
  for (const auto& [name, type] : all_blocks()) {
    EXPECT_NE(list.find("  " + name + " "), list.npos) << name;
    EXPECT_NE(page.find("\n### " + name + "\n"), page.npos) << name;
    const std::string text = block_text(type.info);
    for (const PortInfo& port : type.info.inputs) EXPECT_NE(text.find(port.sentence), text.npos) << name;
    for (const ParameterInfo& parameter : type.info.parameters)
      EXPECT_NE(text.find(parameter.sentence), text.npos) << name;
  }
}

TEST(Reference, BlocksAreFoundByWordsAndByTheirNamesElsewhere) {
  const auto finds = [](const char* words, const char* block) {
    return found_blocks(words).find(std::string("  ") + block + " ") != std::string::npos ||
           found_blocks(words).find(std::string("\"") + block + "\"") != std::string::npos;
  };
  EXPECT_TRUE(finds("mux", "Pack"));
  EXPECT_TRUE(finds("Transfer Fcn", "TransferFunction"));
  EXPECT_TRUE(finds("Gain1", "Gain"));
  EXPECT_TRUE(finds("gain", "MatrixGain"));
  EXPECT_TRUE(finds("TON", "Timer"));
  EXPECT_TRUE(finds("resonance", "Notch")) << "by its sentence";
  EXPECT_TRUE(finds("anti-windup", "PidController")) << "anti_windup is one of its parameters";
  EXPECT_TRUE(finds("hysteresis", "Comparison")) << "by a name elsewhere or a parameter";
  EXPECT_TRUE(finds("torque inertia", "Inertia")) << "each word, in whatever order";
  EXPECT_NE(found_blocks("scope").find("--report"), std::string::npos);
  EXPECT_NE(found_blocks("ode45").find("dopri5"), std::string::npos);
  EXPECT_EQ(found_blocks("xyzzy"), "");
  EXPECT_EQ(found_blocks(""), "");
}

/// "PdController" → "pd_controller", "LuGreFriction" → "lu_gre_friction", "Lookup1D" → "lookup_1d".
std::string file_name(const std::string& type) {
  std::string name;
  for (size_t i = 0; i < type.size(); ++i) {
    const bool begins_word = std::isupper(type[i]) && (i == 0 || !std::isdigit(type[i - 1]));
    const bool begins_number = std::isdigit(type[i]) && !std::isdigit(type[i - 1]);
    if (i > 0 && (begins_word || begins_number)) name += '_';
    name += char(std::tolower(type[i]));
  }
  return name;
}

TEST(Reference, EverySourceFileInBlocksRegistersOneBlockOfItsName) {
  std::set<std::string> sources, registered;
  for (const fs::path& folder : {root, root / "hw"})
    for (const auto& entry : fs::recursive_directory_iterator(folder / "blocks"))
      if (entry.path().extension() == ".cpp" &&
          text_of(entry.path()).find("\nLOOPWRIGHT_BLOCK(") != std::string::npos)
        sources.insert(fs::relative(entry.path(), folder).string());
  for (const auto& [name, type] : all_blocks()) {
    const size_t from = type.info.source.rfind("blocks/");
    ASSERT_NE(from, type.info.source.npos) << type.info.source;
    const std::string source = type.info.source.substr(from);
    EXPECT_TRUE(registered.insert(source).second) << source << " registers two blocks";
    EXPECT_EQ(source, "blocks/" + type.info.room + "/" + file_name(name) + ".cpp");
  }
  EXPECT_EQ(sources, registered);
  EXPECT_GE(sources.size(), 60u);
}

TEST(Reference, EveryBlockHasAnExampleOfItsName) {
  for (const auto& [name, type] : all_blocks()) {
    const fs::path example = root / "diagrams/examples" / (file_name(name) + ".json");
    ASSERT_TRUE(fs::exists(example)) << example;
    EXPECT_NE(text_of(example).find("\"type\": \"" + name + "\""), std::string::npos)
        << example << " shows no " << name;
  }
}

TEST(Reference, EveryBlockHasATest) {
  // In a file of its name, or in a file of its folder that tests it.
  for (const auto& [name, type] : all_blocks()) {
    bool found = false;
    for (const auto& entry : fs::directory_iterator(root / "tests/blocks" / type.info.room))
      if (entry.path().extension() == ".cpp")
        found |= text_of(entry.path()).find("\"" + name + "\"") != std::string::npos;
    EXPECT_TRUE(found) << "tests/blocks/" << type.info.room << " never mentions \"" << name << "\"";
  }
}

void check_words(const std::string& block, const std::vector<ParameterInfo>& parameters) {
  for (const ParameterInfo& parameter : parameters) {
    EXPECT_NE(parameter.name, "") << block;
    EXPECT_NE(parameter.sentence, "") << block << "." << parameter.name;
    check_words(block, parameter.fields);
  }
}

TEST(Reference, EverythingHasASentence) {
  for (const auto& [name, type] : all_blocks()) {
    EXPECT_TRUE(type.info.sentence.ends_with('.')) << name << ": " << type.info.sentence;
    EXPECT_TRUE(std::isupper(type.info.sentence.front())) << name;
    for (const auto* ports : {&type.info.inputs, &type.info.outputs})
      for (const PortInfo& port : *ports) EXPECT_NE(port.sentence, "") << name << "." << port.name;
    check_words(name, type.info.parameters);
  }
}

/// The variables of a unit, "$force", represent units in SI: any unit is suitable for reading the rest.
void check_unit(const std::string& where, std::string_view unit, const std::set<std::string>& known) {
  if (unit.empty() || unit == any_unit || unit == unit_of_output) return;
  const std::string text(unit);
  static const std::regex variable("\\$[a-z_]+");
  for (std::sregex_iterator it(text.begin(), text.end(), variable), end; it != end; ++it)
    EXPECT_TRUE(known.empty() || known.contains(it->str()))
        << where << " [" << unit << "] uses " << it->str() << ", which no port has";
  const auto read = parse_unit(std::regex_replace(text, variable, "1"));
  ASSERT_TRUE(read) << where << " [" << unit << "] cannot be read";
  EXPECT_EQ(read->scale, 1) << where << " [" << unit << "] is not in SI";
}

void check_units(const std::string& block, const std::vector<ParameterInfo>& parameters,
                 const std::set<std::string>& known) {
  for (const ParameterInfo& parameter : parameters) {
    check_unit(block + "." + std::string(parameter.name), parameter.unit, known);
    check_units(block, parameter.fields, known);
    check_units(block, parameter.element, known);
  }
}

TEST(Reference, EveryUnitCanBeReadAndIsInSi) {
  static const std::regex variable("\\$[a-z_]+");
  for (const auto& [name, type] : all_blocks()) {
    std::set<std::string> known{"$none"};
    for (const auto* ports : {&type.info.inputs, &type.info.outputs})
      for (const PortInfo& port : *ports) {
        check_unit(name + "." + std::string(port.name), port.unit, {});
        const std::string text(port.unit);
        for (std::sregex_iterator it(text.begin(), text.end(), variable), end; it != end; ++it)
          known.insert(it->str());
      }
    check_units(name, type.info.parameters, known);
  }
}

}  // namespace
}  // namespace loopwright::reference_test
