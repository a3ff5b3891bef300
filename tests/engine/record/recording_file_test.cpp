#include "engine/record/recording_file.h"

#include <gmock/gmock.h>

#include <fstream>

#include "support.h"

namespace loopwright::recording_file_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(RecordingFile, ChoosesByExtensionInEitherCase) {
  const TemporaryFolder folder;
  const Recording recording{{{"time", "s", {0, 0.1}}, {"x", "m", {1, 2}}}, {{"title", "both"}}};
  for (const std::string name : {"a.csv", "a.mat", "A.CSV", "A.Mat", "two.dots.csv"}) {
    EXPECT_TRUE(is_recording_path(name));
    write_recording(folder / name, recording);
    Problems problems;
    expect_same(recording, read_recording(folder / name, problems));
    EXPECT_EQ(problems.text(), "");
  }
  EXPECT_THAT(bytes_of(folder / "a.csv"), HasSubstr("time [s]"));
  EXPECT_THAT(bytes_of(folder / "A.Mat"), HasSubstr("MATLAB 5.0"));
}

TEST(RecordingFile, RefusesUnknownExtensionsBeforeWriting) {
  const TemporaryFolder folder;
  const Recording recording{{{"time", "s", {0}}}, {}};
  for (const std::string name : {"a.xlsx", "a", "folder.csv/a"}) {
    EXPECT_FALSE(is_recording_path(name));
    EXPECT_THAT([&] { write_recording(folder / name, recording); },
                ThrowsMessage<std::runtime_error>(HasSubstr("expected .csv, .mat or .h5")));
    Problems problems;
    EXPECT_TRUE(read_recording(folder / name, problems).columns.empty());
    EXPECT_THAT(problems.text(), HasSubstr(".mat"));
  }
  EXPECT_EQ(folder.count_files(), 0u);
}

/// The size and, within a clock tick of the file system, the times of both files are the same.
TEST(RecordingFile, AFileThatChangesIsReadAnew) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  for (const double value : {1, 2, 1}) {
    write_recording(path, {{{"time", "s", {0, 1}}, {"x", "m", {0, value}}}, {}});
    for (int times = 0; times < 2; ++times) {
      Problems problems;
      const Recording recording = read_recording(path, problems);
      ASSERT_EQ(recording.columns.size(), 2u) << problems.text();
      EXPECT_EQ(recording.columns[1].values[1], value);
      EXPECT_EQ(problems.files().size(), 1u) << "its contents belong to the identity of what reads it";
    }
  }
}
TEST(RecordingFile, WhatOneReaderAcceptsIsStillAnErrorForAnother) {
  const TemporaryFolder folder;
  const std::string path = folder / "holes.csv";
  std::ofstream(path) << "time [s],x [m]\n0,1\n1,\n";
  Problems accepted, refused;
  EXPECT_EQ(read_recording(path, accepted, {.allow_holes = true}).columns.size(), 2u);
  EXPECT_TRUE(read_recording(path, refused).columns.empty());
  EXPECT_TRUE(refused.has_errors());
}

TEST(Recording, FindsColumnsByName) {
  const Recording recording{{{"a", "", {1}}, {"b", "m", {2}}}, {}};
  ASSERT_NE(recording.find("b"), nullptr);
  EXPECT_EQ(recording.find("b")->unit, "m");
  EXPECT_EQ(recording.find("c"), nullptr);
}

}  // namespace
}  // namespace loopwright::recording_file_test
