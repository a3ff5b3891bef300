#include "engine/record/mat.h"

#include <gmock/gmock.h>
#include <matio.h>
#include <sys/wait.h>

#include <array>

#include "engine/record/mat_layout.h"
#include "engine/record/mat_names.h"
#include "mutation.h"
#include "support.h"

namespace loopwright::mat_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Files written by other programs.
class ForeignFile {
 public:
  explicit ForeignFile(const std::string& path, mat_ft version = MAT_FT_MAT5)
      : file_(Mat_CreateVer(path.c_str(), nullptr, version)) {}
  ~ForeignFile() { Mat_Close(file_); }

  static matvar_t* matrix(const char* name, size_t rows, size_t columns, std::vector<double> values,
                          int flags = 0) {
    std::array<size_t, 2> size = {rows, columns};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), flags);
  }
  void add(matvar_t* variable) {
    ASSERT_EQ(Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE), 0);
    Mat_VarFree(variable);
  }
  void add_matrix(const char* name, size_t rows, size_t columns, std::vector<double> values) {
    add(matrix(name, rows, columns, std::move(values)));
  }
  void add_text(const char* name, std::string text) {
    std::array<size_t, 2> size = {1, text.size()};
    add(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, size.data(), text.data(), 0));
  }

 private:
  mat_t* file_;
};

std::vector<std::string> names(const Recording& recording) {
  std::vector<std::string> list;
  for (const Column& column : recording.columns) list.push_back(column.name);
  return list;
}

Recording read_right(const std::string& path) {
  Problems problems;
  Recording recording = read_mat(path, problems);
  EXPECT_EQ(problems.text(), "");
  return recording;
}

std::string problems_of(const std::string& path, const ReadOptions& options = {}) {
  Problems problems;
  EXPECT_TRUE(read_mat(path, problems, options).columns.empty());
  EXPECT_TRUE(problems.has_errors());
  return problems.text();
}

TEST(MatRoundTrip, RestoresRandomBitPatternsExactly) {
  const TemporaryFolder folder;
  std::mt19937_64 random(1);
  Recording recording;
  for (const char* const name : {"time", "a", "b"}) {
    Column& column = recording.columns.emplace_back(Column{name, "m", edge_numbers()});
    while (column.values.size() < 50'000) column.values.push_back(any_finite(random));
  }
  for (const bool compressed : {true, false}) {
    write_mat(folder / "a.mat", recording, compressed);
    expect_same(recording, read_right(folder / "a.mat"));
  }
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(MatRoundTrip, RestoresAwkwardNamesUnitsAndFacts) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat", awkward_recording());
  expect_same(awkward_recording(), read_right(folder / "a.mat"));
}

TEST(MatRoundTrip, RestoresASingleRowWithFacts) {
  const TemporaryFolder folder;
  const Recording recording{{{"time", "s", {0}}, {"x", "", {-0.0}}}, {{"a", "b"}}};
  write_mat(folder / "a.mat", recording);
  expect_same(recording, read_right(folder / "a.mat"));
}

TEST(MatWrite, GivesEqualFilesForEqualRecordings) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat", awkward_recording());
  write_mat(folder / "b.mat", awkward_recording());
  EXPECT_EQ(bytes_of(folder / "a.mat"), bytes_of(folder / "b.mat"));
}

TEST(MatWrite, UsesNamesThatMatlabUsersFindNatural) {
  EXPECT_THAT(mat::legal_names({"time", "stage.position", "motor.force[2]", "2nd", "for", "", "a.b", "a_b",
                                "loopwright_names"}),
              ElementsAre("time", "stage_position", "motor_force_2", "x_2nd", "x_for", "x_", "a_b", "a_b_2",
                          "loopwright_names_2"));
  const std::vector<std::string> names =
      mat::legal_names({std::string(80, 'a') + "1", std::string(80, 'a') + "2"});
  EXPECT_EQ(names[0].size(), 63u);
  EXPECT_EQ(names[1].size(), 63u);
  EXPECT_NE(names[0], names[1]);
}

TEST(MatWrite, StoresEachColumnAsAnUprightVector) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat", {{{"stage.position", "m", {1, 2, 3}}}, {}});
  mat_t* const file = Mat_Open((folder / "a.mat").c_str(), MAT_ACC_RDONLY);
  ASSERT_NE(file, nullptr);
  matvar_t* const variable = Mat_VarRead(file, "stage_position");
  ASSERT_NE(variable, nullptr);
  EXPECT_EQ(variable->dims[0], 3u);
  EXPECT_EQ(variable->dims[1], 1u);
  EXPECT_EQ(variable->compression, MAT_COMPRESSION_ZLIB);
  Mat_VarFree(variable);
  Mat_Close(file);
}

TEST(MatRead, TurnsVectorsMatricesStructuresAndTextsIntoColumnsAndFacts) {
  const TemporaryFolder folder;
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    {
      ForeignFile file(folder / "a.mat", version);
      file.add_matrix("upright", 3, 1, {1, 2, 3});
      file.add_matrix("lying", 1, 3, {4, 5, 6});
      file.add_matrix("two", 3, 2, {1, 2, 3, 4, 5, 6});
      file.add_matrix("lying_two", 2, 3, {1, 10, 2, 20, 3, 30});
      file.add_matrix("gain", 1, 1, {35.15});
      file.add_text("title", "Bench");
      std::array<const char*, 2> fields = {"v", "w"};
      std::array<size_t, 2> one = {1, 1};
      matvar_t* const structure = Mat_VarCreateStruct("s", 2, one.data(), fields.data(), 2);
      Mat_VarSetStructFieldByName(structure, "v", 0, ForeignFile::matrix(nullptr, 3, 1, {7, 8, 9}));
      Mat_VarSetStructFieldByName(structure, "w", 0, ForeignFile::matrix(nullptr, 3, 1, {7, 7, 7}));
      file.add(structure);
      std::array<size_t, 2> size = {3, 1};
      std::array<int16_t, 3> whole = {-1, 0, 32767};
      file.add(Mat_VarCreate("whole", MAT_C_INT16, MAT_T_INT16, 2, size.data(), whole.data(), 0));
    }
    const Recording recording = read_right(folder / "a.mat");
    std::vector<std::string> sorted = names(recording);
    std::ranges::sort(sorted);  // HDF5 lists variables by name
    EXPECT_THAT(sorted, ElementsAre("lying", "lying_two[0]", "lying_two[1]", "s.v", "s.w", "two[0]", "two[1]",
                                    "upright", "whole"));
    EXPECT_THAT(recording.find("lying")->values, ElementsAre(4, 5, 6));
    EXPECT_THAT(recording.find("two[1]")->values, ElementsAre(4, 5, 6));
    EXPECT_THAT(recording.find("lying_two[1]")->values, ElementsAre(10, 20, 30));
    EXPECT_THAT(recording.find("s.v")->values, ElementsAre(7, 8, 9));
    EXPECT_THAT(recording.find("whole")->values, ElementsAre(-1, 0, 32767));
    EXPECT_THAT(recording.facts,
                testing::UnorderedElementsAre(std::pair<std::string, std::string>("gain", "35.15"),
                                              std::pair<std::string, std::string>("title", "Bench")));
  }
}

/// As Simulink stores "structure with time": two signals, of which the second is a vector.
TEST(MatRead, UnfoldsALogOfSimulinkInBothVersions) {
  const TemporaryFolder folder;
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    {
      ForeignFile file(folder / "a.mat", version);
      std::array<const char*, 3> fields = {"values", "label", "dimensions"};
      std::array<size_t, 2> one = {1, 1}, two = {1, 2}, five = {1, 5};
      matvar_t* const signals = Mat_VarCreateStruct("signals", 2, two.data(), fields.data(), 3);
      std::string label = "speed";
      Mat_VarSetStructFieldByName(signals, "values", 0, ForeignFile::matrix(nullptr, 3, 1, {7, 8, 9}));
      Mat_VarSetStructFieldByName(
          signals, "label", 0,
          Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UINT8, 2, five.data(), label.data(), 0));
      Mat_VarSetStructFieldByName(signals, "dimensions", 0, ForeignFile::matrix(nullptr, 1, 1, {1}));
      Mat_VarSetStructFieldByName(signals, "values", 1,
                                  ForeignFile::matrix(nullptr, 3, 2, {1, 2, 3, 4, 5, 6}));
      std::array<const char*, 2> members = {"time", "signals"};
      matvar_t* const log = Mat_VarCreateStruct("log", 2, one.data(), members.data(), 2);
      Mat_VarSetStructFieldByName(log, "time", 0, ForeignFile::matrix(nullptr, 3, 1, {0, 1, 2}));
      Mat_VarSetStructFieldByName(log, "signals", 0, signals);
      file.add(log);
    }
    const Recording recording = read_right(folder / "a.mat");
    std::vector<std::string> sorted = names(recording);
    std::ranges::sort(sorted);
    EXPECT_THAT(sorted, ElementsAre("log.signals[1][0]", "log.signals[1][1]", "log.speed", "log.time"));
    EXPECT_THAT(recording.find("log.speed")->values, ElementsAre(7, 8, 9));
    EXPECT_THAT(recording.find("log.signals[1][1]")->values, ElementsAre(4, 5, 6));
    EXPECT_TRUE(recording.facts.empty());
  }
}

TEST(MatRead, ReadsVersion4) {
  const TemporaryFolder folder;
  {
    ForeignFile file(folder / "a.mat", MAT_FT_MAT4);
    file.add_matrix("t", 3, 1, {0, 1, 2});
    file.add_matrix("x", 3, 1, {4, 5, 6});
  }
  const Recording recording = read_right(folder / "a.mat");
  EXPECT_THAT(names(recording), ElementsAre("t", "x"));
  EXPECT_THAT(recording.columns[1].values, ElementsAre(4, 5, 6));
}

TEST(MatRead, KeepsColumnsThatWereAddedToOurFile) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat", {{{"stage.x", "m", {1, 2}}, {"stage.y", "m", {3, 4}}}, {{"k", "v"}}});
  mat_t* const file = Mat_Open((folder / "a.mat").c_str(), MAT_ACC_RDWR);
  ASSERT_EQ(Mat_VarDelete(file, "stage_x"), 0);
  matvar_t* const added = ForeignFile::matrix("filtered", 2, 1, {5, 6});
  ASSERT_EQ(Mat_VarWrite(file, added, MAT_COMPRESSION_NONE), 0);
  Mat_VarFree(added);
  Mat_Close(file);
  const Recording recording = read_right(folder / "a.mat");
  EXPECT_THAT(names(recording), ElementsAre("stage.y", "filtered"));
  EXPECT_EQ(recording.columns[0].unit, "m");
  EXPECT_EQ(recording.facts.size(), 1u);
}

TEST(MatProblems, NameEveryVariableThatFitsNoColumn) {
  const TemporaryFolder folder;
  {
    ForeignFile file(folder / "a.mat");
    file.add_matrix("t", 4, 1, {0, 1, 2, 3});
    file.add_matrix("other_rate", 3, 1, {1, 2, 3});
    file.add_matrix("nothing", 0, 0, {});
    std::array<size_t, 3> cube = {2, 2, 2};
    std::array<double, 8> values{};
    file.add(Mat_VarCreate("cube", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, cube.data(), values.data(), 0));
    std::array<size_t, 2> size = {4, 1};
    mat_complex_split_t parts{values.data(), values.data()};
    file.add(Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), &parts, MAT_F_COMPLEX));
  }
  const std::string text = problems_of(folder / "a.mat");
  EXPECT_THAT(text, HasSubstr("variable \"other_rate\" is a 3×1 matrix beside columns of 4 rows"));
  EXPECT_THAT(text, HasSubstr("variable \"nothing\" is an empty matrix"));
  EXPECT_THAT(text, HasSubstr("variable \"cube\" is an array of 3 dimensions"));
  EXPECT_THAT(text, HasSubstr("variable \"z\" is complex numbers"));
  Problems problems;
  const Recording recording = read_mat(folder / "a.mat", problems, {.leave_out_misfits = true});
  EXPECT_FALSE(problems.has_errors());
  EXPECT_EQ(problems.list().size(), 4u);
  EXPECT_THAT(names(recording), ElementsAre("t"));
}

TEST(MatProblems, TellNumbersThatAreNotFinite) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat", {{{"x", "", {1, std::nan(""), INFINITY}}}, {}});
  EXPECT_THAT(problems_of(folder / "a.mat"),
              HasSubstr("column \"x\": 2 values not finite, the first in row 2"));
  Problems problems;
  EXPECT_EQ(read_mat(folder / "a.mat", problems, {.allow_not_finite = true}).rows(), 3u);
}

TEST(MatProblems, TellFilesThatAreNoneOrCutOff) {
  const TemporaryFolder folder;
  EXPECT_THAT(problems_of(folder / "missing.mat"),
              HasSubstr("missing.mat:1:1: error: the file cannot be read"));
  put_bytes(folder / "a.mat", "");
  EXPECT_THAT(problems_of(folder / "a.mat"), HasSubstr("no MAT file"));
  put_bytes(folder / "a.mat", std::string(1000, 'x'));
  EXPECT_THAT(problems_of(folder / "a.mat"), HasSubstr("no MAT file"));
  write_mat(folder / "a.mat", awkward_recording());
  const std::string whole = bytes_of(folder / "a.mat");
  put_bytes(folder / "a.mat", whole.substr(0, whole.size() - 10));
  EXPECT_THAT(problems_of(folder / "a.mat"), HasSubstr("announced with"));
  put_bytes(folder / "a.mat", whole.substr(0, 128));
  EXPECT_THAT(problems_of(folder / "a.mat"), HasSubstr("no numbers"));
}

#if !defined(__SANITIZE_ADDRESS__)  // if memory cannot be limited
TEST(MatProblems, TellFilesThatNeedMoreMemoryThanTheyMayTake) {
  const TemporaryFolder folder;
  write_mat(folder / "a.mat",
            {{{"x", "", std::vector<double>(8'000'000, 0.0)}}, {}});  // 64 MB in a file of 64 kB
  EXPECT_NE(problems_of(folder / "a.mat", {.memory_limit = 1 << 20}), "");
  Problems problems;
  EXPECT_EQ(read_mat(folder / "a.mat", problems).rows(), 8'000'000u);
}
#endif

/// The bytes of valid files of every supported kind.
std::vector<std::string> valid_files() {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  const Recording recording{{{"time", "s", {0, 1, 2}}, {"stage.x", "m", {0.1, 0.2, 0.3}}},
                            {{"title", "a run"}}};
  for (const bool compressed : {true, false}) {
    write_mat(folder / "a.mat", recording, compressed);
    files.push_back(bytes_of(folder / "a.mat"));
  }
  for (const mat_ft version : {MAT_FT_MAT4, MAT_FT_MAT5, MAT_FT_MAT73}) {
    {
      ForeignFile file(folder / "b.mat", version);
      file.add_matrix("t", 3, 1, {0, 1, 2});
      file.add_matrix("m", 3, 2, {1, 2, 3, 4, 5, 6});
      if (version != MAT_FT_MAT4) {
        std::array<const char*, 1> fields = {"v"};
        std::array<size_t, 2> one = {1, 1};
        matvar_t* const structure = Mat_VarCreateStruct("s", 2, one.data(), fields.data(), 1);
        Mat_VarSetStructFieldByName(structure, "v", 0, ForeignFile::matrix(nullptr, 3, 1, {7, 8, 9}));
        file.add(structure);
      }
    }
    files.push_back(bytes_of(folder / "b.mat"));
  }
  return files;
}

TEST(MatMutation, ReadingEndsWithErrorsOrAWellFormedRecording) {
  const TemporaryFolder folder;
  const std::vector<std::string> files = valid_files();
  std::mt19937_64 random(6);
  int refused = 0, read = 0;
  for (int i = 0; i < 600; ++i) {
    const std::string& whole = files[random() % files.size()];
    const std::string damaged = i % 2 == 0 ? mutate(whole, random) : flip_bits(whole, 136, random);
    put_bytes(folder / "damaged.mat", damaged);
    Problems problems;
    const ReadOptions options{.allow_not_finite = random() % 2 == 0, .time_limit = 1};
    const Recording recording = read_mat(folder / "damaged.mat", problems, options);
    ASSERT_TRUE(is_refused_or_well_formed(recording, problems, options)) << "case " << i;
    ++(problems.has_errors() ? refused : read);
  }
  EXPECT_GT(refused, 150);
  EXPECT_GT(read, 50);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was left behind";
}

}  // namespace
}  // namespace loopwright::mat_test
