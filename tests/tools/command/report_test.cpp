// `loopwright report`: which column is the time, and in which unit.
#include <gmock/gmock.h>
#include "tests/tools/command/program.h"

namespace loopwright::report_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class ReportCommand : public testing::Test {
 protected:
  Outcome report(const std::vector<std::string>& recordings) {
    std::vector<std::string> arguments{"report"};
    for (const std::string& name : recordings) arguments.push_back(folder_.path(name));
    arguments.insert(arguments.end(), {"-o", folder_.path("page.html")});
    return Program(arguments).wait();
  }
  std::string page() const { return text_of(folder_.path("page.html")); }
  DiagramFolder folder_;
};

/// A 10 Hz sine of 200 rows, one each ms. Its position stands before its time.
std::string sine(std::string_view heading, double time_scale, bool time_first) {
  std::string text = std::string(heading) + "\n";
  for (int k = 0; k < 200; ++k) {
    const std::string t = fmt::format("{:.17g}", k * time_scale),
                      x = fmt::format("{:.17g}", std::sin(0.0628318530717958647 * k));
    text += (time_first ? t + "," + x : x + "," + t) + "\n";
  }
  return text;
}

TEST_F(ReportCommand, TheTimeIsInSecondsWhereverItStands) {
  folder_.with("s.csv", sine("t [s],x [mm]", 1e-3, true));
  ASSERT_EQ(report({"s.csv"}).code, 0);
  // The pages differ in nothing but the name of the file.
  const auto without_name = [](std::string text, const std::string& name) {
    for (size_t at = text.find(name); at != text.npos; at = text.find(name))
      text.replace(at, name.size(), "?");
    return text;
  };
  const std::string in_seconds = without_name(page(), "s.csv");
  for (const auto& [name, text] :
       {std::pair("m.csv", sine("t [ms],x [mm]", 1, true)), {"o.csv", sine("x [mm],t [ms]", 1, false)}}) {
    folder_.with(name, text);
    const Outcome outcome = report({name});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(without_name(page(), name), in_seconds) << name;
  }
  EXPECT_THAT(page(), Not(HasSubstr("t over time")));
}

TEST_F(ReportCommand, WhatIsNoTimeIsRefusedOrSaid) {
  folder_.with("volt.csv", "a [V],b [V]\n0,1\n1,2\n").with("ms.csv", "t_ms,b [V]\n0,1\n1,2\n");
  EXPECT_EQ(report({"volt.csv"}).code, 2);
  EXPECT_THAT(report({"volt.csv"}).err, HasSubstr("the column \"a\" is no time"));
  EXPECT_EQ(report({"ms.csv"}).code, 2);
  folder_.with("clock.csv", "clock,b [V]\n0,1\n1,2\n");
  const Outcome outcome = report({"clock.csv"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: no column is called time: the first, \"clock\""));
}

TEST_F(ReportCommand, RemarksAndHolesAreNoReasonToRefuse) {
  folder_.with("note.csv", "t;x [m];note;\n0;1;start;\n1;;;\n2;3;;\n");
  const Outcome outcome = report({"note.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(page(), HasSubstr("Rows without a number"));
  folder_.with("hole.csv", "t;x [m]\n0;1\n;2\n2;3\n");
  EXPECT_EQ(report({"hole.csv"}).code, 2);
  EXPECT_THAT(report({"hole.csv"}).err, HasSubstr("hole.csv:3:1: error: column \"t\": an empty cell"));
}

}  // namespace
}  // namespace loopwright::report_test
