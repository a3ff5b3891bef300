// Units of columns, and the choice of the time column.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include "engine/record/column_units.h"
#include "engine/record/csv.h"

namespace loopwright::column_units_test {
namespace {

using testing::HasSubstr;

Recording csv(const std::string& text) {
  Problems problems;
  Recording recording = parse_csv(std::make_shared<SourceFile>(SourceFile{"data.csv", text}), problems);
  EXPECT_EQ(problems.text(), "");
  return recording;
}
/// As from a MAT file: its variables in alphabetical order.
Recording variables(const std::vector<Column>& columns) {
  Recording recording;
  recording.columns = columns, recording.is_ordered = false;
  return recording;
}

class ColumnUnits : public testing::Test {
 protected:
  ColumnError error() {
    return
        [this](std::string message) -> Problem& { return problems_.error({}, "", "", std::move(message)); };
  }
  std::vector<double> time(const Recording& recording, const std::string& name = "") {
    const auto found = time_in_seconds(recording, name, error());
    return found ? found->values : std::vector<double>();
  }
  std::optional<Unit> unit(const Column& column, const std::string& stated) {
    return unit_of(column, stated, error());
  }
  std::string text() const { return problems_.text(); }

  Problems problems_;
};

TEST_F(ColumnUnits, TheHeadingOrTheUserSaysThem) {
  EXPECT_EQ(unit({"x", "mm", {}}, "")->scale, 1e-3);
  EXPECT_EQ(unit({"x", "", {}}, "mm")->scale, 1e-3);
  EXPECT_EQ(unit({"x", "N*m", {}}, "J")->scale, 1) << "the same in other words";
  EXPECT_EQ(text(), "");
}

TEST_F(ColumnUnits, AContradictionNamesBothWithThePlaceOfTheHeading) {
  const Recording recording = csv("# a log\nt [s],x [mm]\n0,1\n1,2\n");
  EXPECT_FALSE(unit(recording.columns[1], "m"));
  EXPECT_THAT(text(), HasSubstr("the column \"x\" has another unit in its file"));
  EXPECT_THAT(text(), HasSubstr("expected: [mm] in data.csv:2:7"));
  EXPECT_THAT(text(), HasSubstr("found: m"));
  EXPECT_FALSE(unit(recording.columns[1], "V"));
}

TEST_F(ColumnUnits, TimeIsTakenInItsOwnUnit) {
  EXPECT_EQ(time(csv("t [ms],x\n0,1\n9,2\n18,3\n")), (std::vector<double>{0, 0.009, 0.018}))
      << "to the last bit";
  EXPECT_EQ(time(csv("time [min],x\n0,1\n2,2\n")), (std::vector<double>{0, 120}));
  EXPECT_EQ(time(csv("t [h],x\n0,1\n1,2\n")), (std::vector<double>{0, 3600}));
  EXPECT_EQ(time(csv("clock,x\n0,1\n9,2\n")), (std::vector<double>{0, 9})) << "the first, in s";
  EXPECT_EQ(time(csv("x,time [us]\n0,0\n1,5\n")), (std::vector<double>{0, 5e-6})) << "by its name";
  EXPECT_EQ(text(), "");
}

TEST_F(ColumnUnits, AColumnWithHolesIsRefusedWhereItIsUsedAtTheCell) {
  Problems none;
  const Recording r =
      parse_csv(std::make_shared<SourceFile>(SourceFile{"data.csv", "t,x,note\n0,1,start\n1,2,\n,3,\n"}),
                none, {.allow_holes = true});
  ASSERT_EQ(none.text(), "");
  EXPECT_NE(find_column(r, "x", error()), nullptr);
  EXPECT_EQ(text(), "");
  EXPECT_EQ(find_column(r, "note", error()), nullptr);
  EXPECT_THAT(text(), HasSubstr("data.csv:2:5: error: column \"note\": text where a number should be"));
  EXPECT_THAT(text(), HasSubstr("data.csv:3:5: error: column \"note\": an empty cell"));
  EXPECT_TRUE(time(r).empty());
  EXPECT_THAT(text(), HasSubstr("data.csv:4:1: error: column \"t\": an empty cell"));
}

TEST_F(ColumnUnits, TheTimeComesFirstForAPage) {
  Recording r = csv("pos [mm],t [ms],force [N]\n5,0,1\n6,9,2\n");
  ASSERT_TRUE(put_time_first(r, error()));
  ASSERT_EQ(r.columns.size(), 3u);
  EXPECT_EQ(r.columns[0].name, "t");
  EXPECT_EQ(r.columns[0].unit, "s");
  EXPECT_EQ(r.columns[0].values, (std::vector<double>{0, 0.009}));
  EXPECT_EQ(r.columns[1].name, "pos");
  ASSERT_TRUE(put_time_first(r, error())) << "again";
  EXPECT_EQ(r.columns[0].values, (std::vector<double>{0, 0.009}));
  Recording two = csv("time [s],t [degC]\n0,20\n1,21\n");
  ASSERT_TRUE(put_time_first(two, error())) << "the first of two that may be the time";
  EXPECT_EQ(two.columns[0].name, "time");
  EXPECT_EQ(text(), "");
  Recording unordered = variables({{"pos", "m", {1, 2}}, {"speed", "m/s", {1, 2}}});
  EXPECT_FALSE(put_time_first(unordered, error()));
}

TEST_F(ColumnUnits, WhatIsNoTimeIsRefused) {
  EXPECT_TRUE(time(csv("x [mm],y\n0,1\n1,2\n")).empty());
  EXPECT_THAT(text(), HasSubstr("the column \"x\" is no time"));
  EXPECT_THAT(text(), HasSubstr("[mm] in data.csv:1:1"));
}

TEST_F(ColumnUnits, ANameThatSaysMillisecondsIsNotTakenForSeconds) {
  EXPECT_TRUE(time(csv("t_ms,y\n0,1\n1,2\n")).empty());
  EXPECT_THAT(text(), HasSubstr("\"t [ms]\" as the heading"));
  EXPECT_EQ(time(csv("t_s,y\n0,1\n1,2\n")), (std::vector<double>{0, 1}));
}

TEST_F(ColumnUnits, TimeInMillisecondsIsTakenInEveryNotation) {
  for (const char* heading : {"t [ms]", "Time (ms)", "time(ms)", "t/ms", "t / ms", "\"Time, ms\""})
    EXPECT_EQ(time(csv(std::string(heading) + ",x\n0,1\n9,2\n")), (std::vector<double>{0, 0.009})) << heading;
  const Recording recording = csv("x,Time (ms)\n7,0\n8,9\n");
  for (const char* name : {"Time (ms)", "Time"})
    EXPECT_EQ(time(recording, name), (std::vector<double>{0, 0.009})) << name;
  EXPECT_EQ(text(), "");
}

TEST_F(ColumnUnits, NamesThatSayAnotherUnitAreNotTakenForSeconds) {
  for (const auto& [name, unit] : std::vector<std::pair<std::string, std::string>>{{"timestamp_millis", "ms"},
                                                                                   {"time_msec", "ms"},
                                                                                   {"timeMs", "ms"},
                                                                                   {"TIME_MS", "ms"},
                                                                                   {"Timems", "ms"},
                                                                                   {"millis", "ms"},
                                                                                   {"milliseconds", "ms"},
                                                                                   {"t_usec", "us"},
                                                                                   {"micros", "us"},
                                                                                   {"time_us_32", "us"},
                                                                                   {"t µs", "us"},
                                                                                   {"time_ns", "ns"},
                                                                                   {"elapsed_min", "min"},
                                                                                   {"t_h", "h"}}) {
    problems_ = {};
    EXPECT_TRUE(time(csv(name + ",y\n0,1\n1,2\n")).empty()) << name;
    EXPECT_THAT(text(), HasSubstr("its name says another one than s")) << name;
    EXPECT_THAT(text(), HasSubstr(" [" + unit + "]\" as the heading")) << name;
  }
  for (const char* name :
       {"ticks", "sample", "Samples", "frames", "tick_count", "sampleIndex", "Time (ticks)"}) {
    problems_ = {};
    EXPECT_TRUE(time(csv(std::string(name) + ",y\n0,1\n1,2\n")).empty()) << name;
    EXPECT_THAT(text(), HasSubstr("its name says that it counts")) << name;
  }
  problems_ = {};
  for (const char* name :
       {"sample_time", "timestamp", "time_s", "t_sec", "seconds", "clock", "min_time", "k"})
    EXPECT_FALSE(time(csv(std::string(name) + ",y\n0,1\n1,2\n")).empty()) << name;
  EXPECT_FALSE(time(csv("time_ms [s],y\n0,1\n1,2\n")).empty()) << "the unit that is stated counts";
  EXPECT_EQ(text(), "");
}

TEST_F(ColumnUnits, TheAlphabetDoesNotChooseTheTime) {
  const Column i{"i", "", {5, 6}}, t{"t", "", {0, 1}}, x{"x", "", {7, 8}};
  EXPECT_EQ(time(variables({i, t, x})), t.values);
  EXPECT_EQ(time(variables({{"log.i", "", {5, 6}}, {"log.time", "ms", {0, 1}}})),
            (std::vector<double>{0, 1e-3}));
  EXPECT_EQ(text(), "");
  EXPECT_TRUE(time(variables({i, x})).empty());
  EXPECT_THAT(text(), HasSubstr("it cannot be told which column is the time"));
  EXPECT_THAT(text(), HasSubstr("one of i, x"));
  EXPECT_EQ(time(variables({i, x}), "x"), x.values);
}

TEST_F(ColumnUnits, TwoTimesAreOneTooMany) {
  EXPECT_TRUE(time(csv("time,t\n0,1\n1,2\n")).empty());
  EXPECT_THAT(text(), HasSubstr("\"time\" and \"t\" may both be the time"));
  EXPECT_EQ(time(csv("time,t\n0,1\n1,2\n"), "t"), (std::vector<double>{1, 2}));
}

}  // namespace
}  // namespace loopwright::column_units_test
