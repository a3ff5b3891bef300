#include <gmock/gmock.h>
#include "engine/diagram/diagram.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::value_file_test {
namespace {

using testing::HasSubstr;

class ValueFile : public ::testing::Test {
 protected:
  auto load(const std::string& block, const std::string& parameters = "{}") {
    folder.with("main.json", R"({"loopwright": 1, "parameters": )" + parameters +
                                 R"(, "solver": {"stop": 1}, "blocks": {"b": )" + block + "}}");
    problems = {};
    return load_diagram(folder.path("main.json"), {}, problems);
  }
  void SetUp() override {
    folder.with("gains.json",
                R"({"K": [[1, 2.5], [3, 4]], "mass": {"value": 250, "unit": "g"}, "text": "=1+1",
        "poles": [{"re": -3}, {"re": -7}]})");
  }
  DiagramFolder folder;
  Problems problems;
};

TEST_F(ValueFile, TakesThePlaceOfAnyValue) {
  const auto diagram =
      load(R"({"type": "MatrixGain", "matrix": {"file": "gains.json", "name": "K"}, "in": {"u": "b.y"}})");
  ASSERT_TRUE(diagram) << problems.text();
  const Value& matrix = diagram->blocks[0].settings.find("matrix")->value;
  ASSERT_EQ(matrix.items.size(), 2u);
  EXPECT_EQ(matrix.items[0].items[1].number, 2.5);
}

TEST_F(ValueFile, IsAParameterWithTheUnitOfTheDiagramOrItsOwn) {
  const auto diagram = load(
      R"({"type": "Constant", "value": "=2*m + pole"})",
      R"({"m": {"file": "gains.json", "name": "mass"}, "pole": {"value": {"file": "gains.json", "name": "poles.1.re"}, "unit": "kg"}})");
  ASSERT_TRUE(diagram) << problems.text();
  EXPECT_NEAR(diagram->blocks[0].settings.find("value")->value.number, 0.5 - 7, 1e-15);
}

/// Like one that is written in the diagram: a bare number keeps the unit that stands in the file.
TEST_F(ValueFile, ABareSettingKeepsItsUnit) {
  folder.with("main.json", R"({"loopwright": 1, "parameters": {"m": {"file": "gains.json", "name": "mass"}},
    "solver": {"stop": 1}, "blocks": {
      "own":   {"type": "Constant", "value": {"file": "gains.json", "name": "mass"}},
      "named": {"type": "Constant", "value": "=m"},
      "K":     {"type": "MatrixGain", "matrix": {"file": "gains.json", "name": "K"}, "in": {"u": ["own.y", "named.y"]}}}})");
  const auto value_with = [&](std::vector<std::pair<std::string, std::string>> set, size_t block,
                              const char* setting) -> Value {
    Problems found;
    const auto diagram = load_diagram(folder.path("main.json"), {.set = std::move(set)}, found);
    EXPECT_FALSE(found.has_errors()) << found.text();
    return diagram ? diagram->blocks[block].settings.find(setting)->value : Value{};
  };
  EXPECT_DOUBLE_EQ(value_with({}, 0, "value").number, 0.25);
  EXPECT_DOUBLE_EQ(value_with({{"own.value", "500"}}, 0, "value").number, 0.5);
  EXPECT_DOUBLE_EQ(value_with({{"own.value", "2 kg"}}, 0, "value").number, 2);
  EXPECT_DOUBLE_EQ(value_with({{"m", "500"}}, 1, "value").number, 0.5);
  EXPECT_DOUBLE_EQ(value_with({{"m", "2 kg"}}, 1, "value").number, 2);
  EXPECT_DOUBLE_EQ(value_with({{"K.matrix.0.1", "7"}}, 2, "matrix").items[0].items[1].number, 7);
}

TEST_F(ValueFile, HoldsNoExpressionsBesideUnitsEither) {
  folder.with("gains.json", R"({"mass": {"value": "=1+1", "unit": "g"}, "arm": {"mass": 3}})");
  EXPECT_FALSE(load(R"({"type": "Constant", "value": {"file": "gains.json", "name": "mass"}})") &&
               !problems.has_errors());
  EXPECT_THAT(problems.text(), HasSubstr("an expression in a file of values"));
  load(R"({"type": "Constant", "value": {"file": "gains.json", "name": "arm.mas"}})");
  EXPECT_THAT(problems.text(), HasSubstr("did you mean \"arm.mass\""));
}

TEST_F(ValueFile, IsOneOfTheFilesThatDetermineTheResult) {
  const auto diagram = load(R"({"type": "Constant", "value": {"file": "gains.json", "name": "K.0.0"}})");
  ASSERT_TRUE(diagram) << problems.text();
  EXPECT_THAT(diagram->files_read, testing::Contains(testing::Field(&FileRead::path, HasSubstr("gains.json"))));
}

TEST_F(ValueFile, SaysWhatIsMissing) {
  const auto text = [&](const char* file, const char* name) {
    load(std::string(R"({"type": "Constant", "value": {"file": ")") + file + R"(", "name": ")" + name +
         "\"}}");
    return problems.text();
  };
  EXPECT_THAT(text("gains.json", "k"),
              testing::AllOf(HasSubstr("contains no \"k\""), HasSubstr("main.json:1:")));
  EXPECT_THAT(text("gains.json", "K.7"), HasSubstr("a list of 2"));
  EXPECT_THAT(text("gains.json", "text"), HasSubstr("an expression"));
  EXPECT_THAT(text("gains.json", "poles"), HasSubstr("this is no value"));
  EXPECT_THAT(text("gain.json", "K"), HasSubstr("gain.json"));
  folder.with("broken.json", "{\"K\": [1, }");
  EXPECT_THAT(text("broken.json", "K"), HasSubstr("broken.json:1:"));
}

}  // namespace
}  // namespace loopwright::value_file_test
