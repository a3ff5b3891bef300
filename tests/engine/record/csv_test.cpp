#include "engine/record/csv.h"

#include <gmock/gmock.h>

#include <chrono>
#include <limits>

#include "engine/record/csv_excel.h"
#include "engine/record/text.h"
#include "parsed_csv.h"
#include "support.h"
#include "where.h"

namespace loopwright::csv_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

void expect_round_trip(const Recording& recording) {
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", recording);
  Problems problems;
  const Recording back = read_csv(folder / "a.csv", problems);
  EXPECT_EQ(problems.text(), "");
  expect_same(recording, back);
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(CsvNumbers, CountsAreWrittenOut) {
  const auto written = [](double value) {
    std::string text;
    append_number(text, value);
    return text;
  };
  EXPECT_EQ(written(100000), "100000") << "not 1e+05";
  EXPECT_EQ(written(999999999999999), "999999999999999");
  EXPECT_EQ(written(-2e6), "-2000000");
  EXPECT_EQ(written(0), "0");
  EXPECT_EQ(written(-0.0), "-0");
  EXPECT_EQ(written(1e15), "1e+15");
  EXPECT_EQ(written(0.1), "0.1");
  EXPECT_EQ(written(1e-7), "1e-07");
  EXPECT_EQ(written(123456.5), "123456.5");
}

TEST(CsvRoundTrip, RestoresRandomBitPatternsExactly) {
  std::mt19937_64 random(1);
  Recording recording;
  for (const char* const name : {"time", "a", "b", "c"}) {
    Column& column = recording.columns.emplace_back(Column{name, "m", edge_numbers()});
    while (column.values.size() < 50'000) column.values.push_back(any_finite(random));
  }
  expect_round_trip(recording);
}

TEST(CsvRoundTrip, RestoresDenormals) {
  std::mt19937_64 random(2);
  Recording recording{{{"x", "", {}}}, {}};
  for (int i = 0; i < 20'000; ++i)
    recording.columns[0].values.push_back(std::bit_cast<double>(random() & 0x800F'FFFF'FFFF'FFFFu));
  expect_round_trip(recording);
}

TEST(CsvRoundTrip, RestoresAwkwardNamesUnitsAndFacts) { expect_round_trip(awkward_recording()); }

TEST(CsvRoundTrip, RestoresEachAwkwardNameAlone) {
  const Recording all = awkward_recording();
  for (const Column& column : all.columns) expect_round_trip(Recording{{column}, {}});
  for (const Column& column : all.columns)
    expect_round_trip(Recording{{column, {"other", "s", {4, 5, 6}}}, {}});
}

TEST(CsvRoundTrip, RestoresRandomTexts) {
  std::mt19937_64 random(3);
  constexpr std::string_view alphabet = "ab1[]()\\nx:;,\t\n\r \"'#.\xC3\xA9\xFF=";
  const auto text = [&](size_t least) {
    std::string result;
    const size_t length = least + random() % 8;
    while (result.size() < length) result += alphabet[random() % alphabet.size()];
    return result;
  };
  for (int i = 0; i < 300; ++i) {
    Recording recording;
    for (const std::string end : {"1", "2", "3"})
      recording.columns.push_back({text(1) + end, text(0), {any_finite(random), any_finite(random)}});
    for (size_t facts = random() % 3; facts > 0; --facts) recording.facts.emplace_back(text(0), text(0));
    expect_round_trip(recording);
    if (HasFailure()) FAIL() << "recording " << i;
  }
}

TEST(CsvRoundTrip, RestoresNanAndInfinityWhenTheyArePermitted) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Recording recording{{{"x", "", {infinity, -infinity, std::nan(""), 1}}}, {}};
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", recording);
  Problems problems;
  const Recording back = read_csv(folder / "a.csv", problems, {.allow_not_finite = true});
  ASSERT_EQ(back.rows(), 4u) << problems.text();
  EXPECT_EQ(back.columns[0].values[0], infinity);
  EXPECT_EQ(back.columns[0].values[1], -infinity);
  EXPECT_TRUE(std::isnan(back.columns[0].values[2]));
}

TEST(CsvWrite, IsPlainWhenNothingNeedsEscaping) {
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", {{{"time", "s", {0, 0.1}}, {"motor.force[2]", "", {-0.0, 1e300}}}, {}});
  EXPECT_EQ(bytes_of(folder / "a.csv"), "time [s],motor.force[2]\n0,-0\n0.1,1e+300\n");
}

TEST(CsvWrite, PutsFactsFirst) {
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", {{{"x", "m", {1}}}, {{"plan", "ab12"}, {"two", "a\nb"}}});
  EXPECT_EQ(bytes_of(folder / "a.csv"), "# loopwright recording: 1\n# plan: ab12\n# two: a\\nb\nx [m]\n1\n");
}

TEST(CsvWrite, RefusesRecordingsThatAreNotWellFormed) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_csv(folder / "a.csv", {{{"x", "", {1}}, {"x", "", {2}}}, {}}), std::invalid_argument);
  EXPECT_THROW(write_csv(folder / "a.csv", {{{"x", "", {1}}, {"y", "", {}}}, {}}), std::invalid_argument);
  EXPECT_THROW(write_csv(folder / "a.csv", {{{"", "", {1}}}, {}}), std::invalid_argument);
  EXPECT_EQ(folder.count_files(), 0u);
}

TEST(CsvRead, UnderstandsOtherPeoplesFiles) {
  const std::vector<std::string> same_table = {
      "t,x\n0,1.5\n1,-2e3\n",        // plain
      "t,x\n0,1.5\n1,-2e3",          // no newline at the end
      "t,x\r\n0,1.5\r\n1,-2e3\r\n",  // Windows
      "t,x\r0,1.5\r1,-2e3\r",        // old Macintosh
      "\xEF\xBB\xBFt,x\n0,1.5\n1,-2e3\n",
      "t;x\n0;1.5\n1;-2e3\n",
      "t\tx\n0\t1.5\n1\t-2e3\n",
      "t x\n0 1.5\n1    -2e3\n",
      "  t   x  \n  0 1.5  \n  1 -2e3\n",
      " t , x \n 0 ,\t1.5 \n1, -2e3 \n",
      "\"t\",\"x\"\n0,1.5\n1,-2e3\n",
      "\"t\";x\n\"0\";\"1.5\"\n+1;-2.0E+03\n",
      "t,x\n\n0,1.5\n1,-2e3\n\n\n",
      "t,x\n0,1.5\n# paused here\n1,-2e3\n",
      "# t,x\n0,1.5\n1,-2e3\n",  // numpy.savetxt
      "# t x\n0 1.5\n1 -2e3\n",  // gnuplot
  };
  for (const std::string& text : same_table) {
    const Recording recording = parse_right(text);
    ASSERT_THAT(names(recording), ElementsAre("t", "x")) << text;
    EXPECT_THAT(recording.columns[0].values, ElementsAre(0, 1)) << text;
    EXPECT_THAT(recording.columns[1].values, ElementsAre(1.5, -2000)) << text;
  }
}

TEST(CsvRead, NamesColumnsThatHaveNoHeader) {
  const Recording recording = parse_right("0,1\n2,3\n");
  EXPECT_THAT(names(recording), ElementsAre("c1", "c2"));
  EXPECT_THAT(recording.columns[1].values, ElementsAre(1, 3));
}

TEST(CsvRead, TakesUnitsFromBrackets) {
  const Recording recording = parse_right("t [s],speed[m/s],force[2],\"a, b [N]\"\n1,2,3,4\n");
  EXPECT_THAT(names(recording), ElementsAre("t", "speed", "force[2]", "a, b"));
  EXPECT_EQ(recording.columns[0].unit, "s");
  EXPECT_EQ(recording.columns[1].unit, "m/s");
  EXPECT_EQ(recording.columns[2].unit, "");
  EXPECT_EQ(recording.columns[3].unit, "N");
}

TEST(CsvRead, TakesUnitsInTheNotationsOfOtherPrograms) {
  const std::vector<std::array<const char*, 3>> cases = {{"Time (ms)", "Time", "ms"},
                                                         {"time(ms)", "time", "ms"},
                                                         {"t/ms", "t", "ms"},
                                                         {"Time, ms", "Time", "ms"},
                                                         {"F(N)", "F", "N"},
                                                         {"F/N", "F", "N"},
                                                         {"v/(m/s)", "v", "m/s"},
                                                         {"v (mm/s)", "v", "mm/s"},
                                                         {"x / mm", "x", "mm"},
                                                         {"Time (min)", "Time", "min"},
                                                         {"torque (Nm)", "torque", "Nm"},
                                                         {"duty (%)", "duty", "%"},
                                                         {"load (t)", "load", "t"},
                                                         {"s/mm", "s", "mm"},
                                                         {"m/kg", "m", "kg"},
                                                         {"drive.pos (mm)", "drive.pos", "mm"}};
  for (const auto& [heading, name, unit] : cases) {
    const Recording recording = parse_right(fmt::format("y;\"{}\"\n1;2\n", heading));
    EXPECT_EQ(recording.columns[1].name, name) << heading;
    EXPECT_EQ(recording.columns[1].unit, unit) << heading;
    EXPECT_EQ(recording.find(heading), &recording.columns[1]) << heading;
    EXPECT_EQ(recording.find(name), &recording.columns[1]) << heading;
  }
}

TEST(CsvRead, LeavesNamesThatAreNoUnits) {
  for (const char* heading :
       {"f(x)", "x(t)",         "max(F)",  "u/2",     "x (1)",       "km/h",  "m/s",
        "N/A",  "dx/dt",        "y (raw)", "x (min)", "force (max)", "x (-)", "motor.force[2]",
        "a, b", "pos (actual)", "w/o",     "on/off",  "I/O",         "x/y",   "(mm)",
        "t(x)", "Channel (1)",  "u(k)",    "y(k+1)"}) {
    const Recording recording = parse_right(fmt::format("z;\"{}\"\n1;2\n", heading));
    EXPECT_EQ(recording.columns[1].name, heading);
    EXPECT_EQ(recording.columns[1].unit, "") << heading;
  }
}

TEST(CsvRead, KeepsHeadingsThatOnlyUnitsDistinguish) {
  const Recording recording = parse_right("F (N),F (V),x\n1,2,3\n");
  EXPECT_THAT(names(recording), ElementsAre("F (N)", "F (V)", "x"));
  EXPECT_EQ(recording.columns[0].unit, "N");
  EXPECT_EQ(recording.columns[1].unit, "V");
}

TEST(CsvRoundTrip, RestoresNamesThatLookLikeHeadingsWithUnits) {
  Recording recording;
  for (const char* name : {"x (mm)", "x/mm", "x, mm", "v/(m/s)"})
    recording.columns.push_back({name, "", {1, 2}});
  recording.columns[1].unit = "N";
  expect_round_trip(recording);
}

TEST(CsvRead, TakesFactsFromCommentsLiterally) {
  const Recording recording = parse_right("# file: C:\\new\n# recorded at 10:30:00\n#\nt\n1\n");
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"file", "C:\\new"}, {"comment", "recorded at 10:30:00"}, {"comment", ""}};
  EXPECT_EQ(recording.facts, facts);
}

TEST(CsvRead, ReadsOneColumn) {
  EXPECT_THAT(parse_right("x\n1\n2\n").columns[0].values, ElementsAre(1, 2));
  EXPECT_THAT(parse_right("1\n2").columns[0].values, ElementsAre(1, 2));
}

TEST(CsvProblems, NameTheSpotOfEveryBadCellAtOnce) {
  const std::string text = problems_of("t,x\n0,1\n1,abc\n2,\n3,4,5\n4\n5,nan\n6,1e999\n");
  EXPECT_THAT(text, HasSubstr("data.csv:3:3: error: column \"x\": text where a number should be"));
  EXPECT_THAT(text, HasSubstr("found: abc"));
  EXPECT_THAT(text, HasSubstr("data.csv:4:3: error: column \"x\": an empty cell"));
  EXPECT_THAT(text, HasSubstr("data.csv:5:1: error: a row of another length"));
  EXPECT_THAT(text, HasSubstr("found: 3 cells"));
  EXPECT_THAT(text, HasSubstr("data.csv:6:1: error: a row of another length"));
  EXPECT_THAT(text, HasSubstr("data.csv:7:3: error: column \"x\": not a finite number"));
  EXPECT_THAT(text, HasSubstr("data.csv:8:3: error: column \"x\": a number beyond the range of a double"));
  EXPECT_THAT(text, HasSubstr("6 errors"));
}

TEST(CsvProblems, AreCappedAndTheRestCounted) {
  std::string text = "t,x\n";
  for (int i = 0; i < 100; ++i) text += "1,?\n";
  Problems problems;
  parse(text, problems);
  ASSERT_EQ(problems.list().size(), 21u);
  EXPECT_THAT(problems.list().back().message, HasSubstr("80 more problems"));
  Problems few;
  parse(text, few, {.most_problems = 3});
  EXPECT_EQ(few.list().size(), 4u);
}

TEST(CsvRead, ReadsDecimalCommasWhereAnotherCharacterSeparatesCells) {
  const std::vector<double> expected{1.5, -2.5e-3};
  for (const std::string text : {"t;x\n0,0;1,5\n1;-2,5e-3\n", "t x\n0,0 1,5\n1 -2,5e-3\n",
                                 "t\tx\n0,0\t1,5\n1\t-2,5e-3\n", "t,x\n\"0,0\",\"1,5\"\n1,\"-2,5e-3\"\n"})
    EXPECT_EQ(parse_right(text).columns[1].values, expected) << text;
  // One number that does not begin with a group of thousands decides for the whole file.
  EXPECT_EQ(parse_right("t;x\n0,000;1,234\n0,001;12,345\n").columns[1].values,
            (std::vector<double>{1.234, 12.345}));
}

TEST(CsvRoundTrip, ReadsTablesForSpreadsheets) {
  Recording recording;
  recording.columns = {{"t", "s", {0, 0.5, 1}}, {"x", "mm", {1234.567, -1e-7, 3}}};
  const std::string path = testing::TempDir() + "spreadsheet.csv";
  write_excel_csv(path, recording);
  Problems problems;
  const Recording read = read_csv(path, problems);
  ASSERT_FALSE(problems.has_errors());
  for (size_t i = 0; i < recording.columns.size(); ++i) {
    EXPECT_EQ(read.columns[i].name, recording.columns[i].name);
    EXPECT_EQ(read.columns[i].unit, recording.columns[i].unit);
    EXPECT_EQ(read.columns[i].values, recording.columns[i].values);
  }
}

TEST(CsvProblems, CommasThatMaySeparateThousandsAreRefused) {
  const std::string open = problems_of("t;x\n0;1,234\n1;12,345\n");
  EXPECT_THAT(open,
              HasSubstr("data.csv:2:3: error: a comma that may be a decimal comma or separate thousands"));
  EXPECT_THAT(problems_of("t;x\n0.5;1,25\n"), HasSubstr("2:5: error: numbers with commas and with points"));
  EXPECT_THAT(problems_of("t;x\n0,5;1,25\n1;2\n2;.5\n"), HasSubstr("0,5, and a point in line 4"));
  EXPECT_THAT(problems_of("t;x\n0;1,234,567\n"), HasSubstr("text where a number should be"));
  EXPECT_THAT(problems_of("t,x\n0,001,1,5\n"), HasSubstr("decimal commas?"));
  EXPECT_THAT(problems_of("x\n1,5\n"), HasSubstr("decimal commas?"));
}

TEST(CsvRead, ObeysTheSeparatorThatExcelStates) {
  for (const std::string text : {"sep=;\nt;x\n0;1.5\n1;2\n", "SEP=;\r\nt;x\r\n0;1,5\r\n1;2\r\n",
                                 "\xEF\xBB\xBFsep=,\nt,x\n0,1.5\n1,2\n", "\"sep=|\"\nt|x\n0|1.5\n1|2\n",
                                 "sep=\t\nt\tx\n0\t1.5\n1\t2\n"}) {
    const Recording r = parse_right(text);
    ASSERT_THAT(names(r), ElementsAre("t", "x")) << text;
    EXPECT_THAT(r.columns[1].values, ElementsAre(1.5, 2)) << text;
  }
}

TEST(CsvRead, ADashInBracketsIsTheUnitOne) {
  const Recording r = parse_right("t [s],slip [-],\"gain[-]\"\n0,1,2\n");
  EXPECT_EQ(r.columns[1].name, "slip");
  EXPECT_EQ(r.columns[1].unit, "1");
  EXPECT_EQ(r.columns[2].unit, "1");
  EXPECT_EQ(r.find("slip [-]"), &r.columns[1]);
  Recording own;
  own.columns = {{"x", "-", {1}}, {"a, b", "-", {1}}};
  own.facts = {{"title", "escaped"}};
  expect_round_trip(own);
}

TEST(CsvProblems, TellAFileThatIsNoTable) {
  EXPECT_THAT(problems_of(""), HasSubstr("the file is empty"));
  EXPECT_THAT(problems_of("# only: facts\n"), HasSubstr("no table of numbers"));
  EXPECT_THAT(problems_of("t,x\n"), HasSubstr("no rows"));
  EXPECT_THAT(problems_of(std::string("t,x\n1,\0002\n", 9)),
              HasSubstr("data.csv:2:3: error: the file is not UTF-8"));
  EXPECT_THAT(problems_of("t,\xB5m\n1,2\n"), HasSubstr("data.csv:1:3: error: the file is not UTF-8"));
  EXPECT_THAT(problems_of("\xFF\xFEt\n"), HasSubstr("UTF-16"));
  EXPECT_THAT(problems_of("t,x\n" + std::string(2 << 20, '1') + "\n"),
              HasSubstr("data.csv:2:1: error: this line is too"));
}

TEST(CsvProblems, TellColumnsWithoutAName) {
  EXPECT_THAT(problems_of("t,x,t\n1,2,3\n"), HasSubstr("data.csv:1:5: error: two columns are named \"t\""));
  EXPECT_THAT(problems_of("t,,x\n1,2,3\n"), HasSubstr("data.csv:1:3: error: column 2 has no name"));
  EXPECT_THAT(problems_of("t,x,\n1,2,\n"), HasSubstr("a separator too many"));
  EXPECT_THAT(problems_of("t,\"x\n1,2\n"), HasSubstr("not closed"));
}

TEST(CsvProblems, TellALastRowThatIsCutOff) {
  EXPECT_THAT(problems_of("t,x\n0,1\n1"), HasSubstr("data.csv:3:1: error: the last row is cut off"));
  EXPECT_THAT(problems_of("t,x\n0,1\n1\n"), Not(HasSubstr("cut off"))) << "the row was ended: it is ragged";
}

TEST(CsvProblems, TellASecondHeaderAndASecondTable) {
  EXPECT_THAT(problems_of("t,x\n(s),(m)\n0,1\n"), HasSubstr("a second header line?"));
  EXPECT_THAT(problems_of("t,x\n0,1\n\n0,1\n"), HasSubstr("data.csv:3:1: error: an empty line within"));
}

TEST(CsvProblems, KeepADamagedFirstRowFromPassingForAHeader) {
  EXPECT_THAT(problems_of("0,1,2\x60\n1,2,3\n"), HasSubstr("data.csv:1:5: error: column \"c3\": text"));
}

TEST(CsvProblems, TellFilesThatCannotBeRead) {
  const TemporaryFolder folder;
  Problems problems;
  read_csv(folder / "missing.csv", problems);
  read_csv(folder / ".", problems);
  read_csv("/dev/zero", problems);
  EXPECT_THAT(problems.text(),
              HasSubstr("missing.csv:1:1: error: the file cannot be read: there is no such file"));
  EXPECT_THAT(problems.text(), HasSubstr("it is a folder"));
  EXPECT_THAT(problems.text(), HasSubstr("/dev/zero:1:1: error: the file cannot be read: it is a device"));
}

TEST(CsvRead, ReadsTheMeasuredEmpsRecording) {
  const char* const folder = std::getenv("LOOPWRIGHT_DATA");
  const std::string data = folder ? folder : std::string(LOOPWRIGHT_SOURCE) + "/../shared/data";
  const std::string path = data + "/emps/emps_train.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set LOOPWRIGHT_DATA";
  Problems problems;
  const auto start = std::chrono::steady_clock::now();
  const Recording recording = read_csv(path, problems);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", std::to_string(1e3 * taken.count()));
  EXPECT_EQ(problems.text(), "");
  EXPECT_THAT(names(recording), ElementsAre("t_s", "q_ref_m", "q_meas_m", "u_V", "F_motor_N"));
  ASSERT_EQ(recording.rows(), 24841u);
  EXPECT_EQ(recording.find("q_ref_m")->values[1], 0.00012172102);
  EXPECT_EQ(recording.find("t_s")->values.back(), 24.84);
  expect_round_trip(recording);
}

}  // namespace
}  // namespace loopwright::csv_test
