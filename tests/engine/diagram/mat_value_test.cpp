// Values of a diagram from MAT files, written here by matio; those of SciPy and h5py are in tests/reference.
#include <gmock/gmock.h>
#include <array>
#include <limits>
#include <matio.h>
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::mat_value_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

matvar_t* numbers(const char* name, size_t rows, size_t columns, std::vector<double> values, int flags = 0) {
  std::array<size_t, 2> size = {rows, columns};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), flags);
}
matvar_t* text(const char* name, std::string words) {
  std::array<size_t, 2> size = {1, words.size()};
  return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, size.data(), words.data(), 0);
}
matvar_t* structures(const char* name, std::vector<const char*> fields, std::vector<matvar_t*> values) {
  std::array<size_t, 2> size = {1, values.size() / fields.size()};
  matvar_t* made = Mat_VarCreateStruct(name, 2, size.data(), fields.data(), unsigned(fields.size()));
  for (size_t i = 0; i < values.size(); ++i)
    Mat_VarSetStructFieldByIndex(made, i % fields.size(), i / fields.size(), values[i]);
  return made;
}

class MatValue : public ::testing::Test {
 protected:
  void write(const char* name, std::vector<matvar_t*> variables, mat_ft version = MAT_FT_MAT5) {
    mat_t* file = Mat_CreateVer(folder.path(name).c_str(), nullptr, version);
    ASSERT_NE(file, nullptr);
    for (matvar_t* variable : variables) {
      ASSERT_EQ(Mat_VarWrite(file, variable, MAT_COMPRESSION_ZLIB), 0);
      Mat_VarFree(variable);
    }
    Mat_Close(file);
  }
  void SetUp() override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    mat_complex_split_t parts{};
    double real = 1, imaginary = 2;
    parts.Re = &real, parts.Im = &imaginary;
    std::array<size_t, 2> one = {1, 1};
    std::array<size_t, 3> cube = {2, 2, 2};
    std::array<double, 8> eight{};
    uint8_t yes = 1;
    write("gains.mat",
          {numbers("K", 2, 3, {1, 4, 2, 5, 3, 6}), numbers("mass", 1, 1, {250}),
           numbers("row", 1, 3, {1, 2, 3}), numbers("upright", 3, 1, {1, 2, 3}),
           numbers("holed", 2, 2, {1, 2, nan, 4}), text("hello", "=1+1"), text("method", "linear"),
           Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one.data(), &parts, MAT_F_COMPLEX),
           Mat_VarCreate("cube", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, cube.data(), eight.data(), 0),
           Mat_VarCreate("on", MAT_C_UINT8, MAT_T_UINT8, 2, one.data(), &yes, MAT_F_LOGICAL),
           structures(
               "plant", {"mass", "width"},
               {numbers("mass", 1, 1, {3}),
                structures("width", {"value", "unit"}, {numbers("value", 1, 1, {25}), text("unit", "mm")})}),
           structures("poles", {"re", "im"},
                      {numbers("re", 1, 1, {-3}), numbers("im", 1, 1, {0}), numbers("re", 1, 1, {-7}),
                       numbers("im", 1, 1, {2})})});
  }
  std::shared_ptr<const Diagram> load(const std::string& block, const std::string& parameters = "{}") {
    folder.with("main.json", R"({"loopwright": 1, "parameters": )" + parameters +
                                 ",\n"
                                 R"( "solver": {"method": "rk4", "step": 1, "stop": 1}, "blocks": {"b": )" +
                                 block + R"(, "c": {"type": "Constant", "value": [1, 2, 3]}}})");
    problems = {};
    return load_diagram(folder.path("main.json"), {}, problems);
  }
  double constant(const std::string& name) {
    const auto diagram =
        load(R"({"type": "Constant", "value": {"file": "gains.mat", "name": ")" + name + "\"}}");
    EXPECT_EQ(problems.text(), "") << name;
    return setting_of(*diagram, "b", "value").number;
  }
  /// Everything that is wrong with a block.
  std::string refused(const std::string& block, const std::string& parameters = "{}") {
    const auto diagram = load(block, parameters);
    if (diagram && !problems.has_errors()) compile(*diagram, problems);
    EXPECT_TRUE(problems.has_errors()) << block;
    return problems.text();
  }
  std::string refused_constant(const std::string& file, const std::string& name) {
    return refused(R"({"type": "Constant", "value": {"file": ")" + file + R"(", "name": ")" + name + "\"}}");
  }
  /// The rows of the matrix that a MatrixGain got.
  std::string gain(const std::string& name, const std::string& input) {
    const auto diagram = load(R"({"type": "MatrixGain", "matrix": {"file": "gains.mat", "name": ")" + name +
                              R"("}, "in": {"u": )" + input + "}}");
    if (!diagram) return problems.text();
    const auto plan = compile(*diagram, problems);
    if (!plan) return problems.text();
    for (const auto& [path, value] : plan->parameters)
      if (path == "b.matrix") return value;
    return "none";
  }
  DiagramFolder folder;
  Problems problems;
};

TEST_F(MatValue, NamesVariablesFieldsAndElements) {
  EXPECT_EQ(constant("mass"), 250);
  EXPECT_EQ(constant("plant.mass"), 3);
  EXPECT_EQ(constant("poles.1.re"), -7);
  EXPECT_EQ(constant("row.2"), 3);
  EXPECT_EQ(constant("upright.0"), 1);
  EXPECT_DOUBLE_EQ(constant("plant.width"), 0.025) << "a number with a unit, as in JSON";
}

TEST_F(MatValue, ReadsMatricesRowByRow) {
  EXPECT_EQ(constant("K.0.1"), 2);
  EXPECT_EQ(constant("K.1.0"), 4);
  EXPECT_EQ(gain("K", R"("c.y")"), "[[1,2,3],[4,5,6]]");
}

TEST_F(MatValue, OneRowOrColumnIsAMatrixWhereTheBlockTakesOne) {
  EXPECT_EQ(gain("row", R"("c.y")"), "[[1,2,3]]");
  EXPECT_EQ(gain("upright", R"("c.y[0]")"), "[[1],[2],[3]]");
  EXPECT_EQ(gain("mass", R"("c.y[0]")"), "[[250]]");
}

TEST_F(MatValue, OneRowOrColumnIsAListWhereTheBlockTakesOne) {
  const auto diagram = load(R"({"type": "Constant", "value": {"file": "gains.mat", "name": "upright"}})");
  ASSERT_TRUE(diagram) << problems.text();
  const auto plan = compile(*diagram, problems);
  ASSERT_TRUE(plan) << problems.text();
  EXPECT_EQ(plan->find("b.y").size(), 3u);
  const auto list = load(R"({"type": "TransferFunction", "numerator": {"file": "gains.mat", "name": "mass"},
      "denominator": {"file": "gains.mat", "name": "row"}, "in": {"u": "c.y[0]"}})");
  ASSERT_TRUE(list) << problems.text();
  EXPECT_TRUE(compile(*list, problems)) << problems.text();
}

TEST_F(MatValue, IsAParameterWithItsUnit) {
  const auto diagram = load(R"({"type": "Constant", "value": "=2*m + width/2"})",
                            R"({"m": {"value": {"file": "gains.mat", "name": "mass"}, "unit": "mm"},
      "width": {"file": "gains.mat", "name": "plant.width"}, "matrix": {"file": "gains.mat", "name": "row"}})");
  ASSERT_EQ(problems.text(), "");
  EXPECT_DOUBLE_EQ(setting_of(*diagram, "b", "value").number, 0.5 + 0.0125);
}

TEST_F(MatValue, TextsAndFlagsAreThoseOfJson) {
  const auto diagram = load(R"({"type": "Lookup1D", "breakpoints": {"file": "gains.mat", "name": "row"},
      "values": {"file": "gains.mat", "name": "upright"}, "interpolation": {"file": "gains.mat", "name": "method"},
      "in": {"u": "c.y[0]"}})");
  ASSERT_TRUE(diagram) << problems.text();
  EXPECT_EQ(setting_of(*diagram, "b", "interpolation").text, "linear");
  EXPECT_TRUE(compile(*diagram, problems)) << problems.text();
  const auto flag = load(R"({"type": "Constant", "value": 1, "on": {"file": "gains.mat", "name": "on"}})");
  EXPECT_EQ(setting_of(*flag, "b", "on").kind, Value::Kind::boolean);
}

TEST_F(MatValue, ReadsEveryVersion) {
  for (const mat_ft version : {MAT_FT_MAT4, MAT_FT_MAT5, MAT_FT_MAT73}) {
    write("gains.mat", {numbers("K", 2, 3, {1, 4, 2, 5, 3, 6})}, version);
    EXPECT_EQ(constant("K.1.2"), 6);
    EXPECT_EQ(constant("K.0.2"), 3);
  }
}

TEST_F(MatValue, SaysAtTheReferenceWhatIsWrong) {
  EXPECT_THAT(refused_constant("gains.mat", "masse"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("contains no \"masse\""),
                    HasSubstr("did you mean \"mass\"?")));
  EXPECT_THAT(refused_constant("gains.mat", "plant.x"), HasSubstr("one of plant.mass, plant.width"));
  EXPECT_THAT(refused_constant("gains.mat", "mass.x"), HasSubstr("the number 250 before \"x\""));
  EXPECT_THAT(refused_constant("gains.mat", "row.3"), HasSubstr("a list of 3"));
  EXPECT_THAT(refused_constant("gains.mat", "plant"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("this is no value")));
  EXPECT_THAT(refused_constant("gains.mat", "z"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("complex numbers")));
  EXPECT_THAT(refused_constant("gains.mat", "cube"), HasSubstr("an array of 3 dimensions"));
  EXPECT_THAT(refused_constant("gains.mat", "holed"), HasSubstr("nan at holed.0.1"));
  EXPECT_THAT(refused_constant("gains.mat", "hello"), HasSubstr("an expression in a file of values"));
  EXPECT_THAT(refused_constant("gain.mat", "K"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("there is no such file"), HasSubstr("gains.mat")));
}

TEST_F(MatValue, SaysWhichShapeIsExpected) {
  EXPECT_THAT(
      refused(
          R"({"type": "MatrixGain", "matrix": {"file": "gains.mat", "name": "method"}, "in": {"u": "c.y"}})"),
      AllOf(HasSubstr("main.json:2:"), HasSubstr("a list"), HasSubstr("the text \"linear\"")));
  EXPECT_THAT(
      refused(
          R"({"type": "TransferFunction", "numerator": [1], "denominator": {"file": "gains.mat", "name": "K"},
      "in": {"u": "c.y[0]"}})"),
      AllOf(HasSubstr("main.json:2:"), HasSubstr("expected: a list"),
            HasSubstr("a matrix of 2 rows and 3 columns")));
  EXPECT_THAT(
      refused(R"({"type": "Sine", "amplitude": 1, "frequency": {"file": "gains.mat", "name": "hello"}})"),
      HasSubstr("main.json:2:"));
}

TEST_F(MatValue, RefusesWhatIsNoMatFile) {
  folder.with("other.mat", R"({"K": 1})");
  EXPECT_THAT(refused_constant("other.mat", "K"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("this is no MAT file")));
  std::ifstream whole(folder.path("gains.mat"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  folder.with("cut.mat", std::string_view(bytes).substr(0, bytes.size() / 2));
  EXPECT_THAT(refused_constant("cut.mat", "K"),
              AllOf(HasSubstr("main.json:2:"), HasSubstr("was the copy complete?")));
}

TEST_F(MatValue, IsOneOfTheFilesThatDetermineTheResult) {
  const char* block = R"({"type": "Constant", "value": {"file": "gains.mat", "name": "mass"}})";
  const auto first = load(block);
  write("gains.mat", {numbers("mass", 1, 1, {250}), numbers("more", 1, 1, {1})});
  const auto second = load(block);
  const auto hash = [](const Diagram& diagram) {
    for (const FileRead& file : diagram.files_read)
      if (file.path.ends_with("gains.mat")) return file.hash;
    return std::string();
  };
  EXPECT_NE(hash(*first), "");
  EXPECT_NE(hash(*first), hash(*second));
}

}  // namespace
}  // namespace loopwright::mat_value_test
