#include "engine/json/problem.h"
#include <gtest/gtest.h>
#include <algorithm>

namespace loopwright::problem_test {
namespace {

std::shared_ptr<const SourceFile> source(std::string name, std::string text) {
  return std::make_shared<SourceFile>(SourceFile{std::move(name), std::move(text)});
}

TEST(LineColumn, CountsLinesAndCharactersFromOne) {
  const auto file = source("a.json", "ab\ncd\n");
  EXPECT_EQ(line_column({file, 0}).line, 1);
  EXPECT_EQ(line_column({file, 0}).column, 1);
  EXPECT_EQ(line_column({file, 4}).line, 2);
  EXPECT_EQ(line_column({file, 4}).column, 2);
  EXPECT_EQ(line_column({file, 6}).line, 3);
}

TEST(LineColumn, CountsCharactersNotBytes) {
  const auto file = source("a.json", "µ→𝄞x");
  EXPECT_EQ(line_column({file, 9}).column, 4);
}

TEST(LineColumn, LeavesTheByteOrderMarkOut) {
  const auto file = source("a.json", "\xEF\xBB\xBF{");
  EXPECT_EQ(line_column({file, 3}).column, 1);
}

TEST(LineColumn, StopsAtTheEndOfTheText) {
  const auto file = source("a.json", "ab");
  EXPECT_EQ(line_column({file, 4000}).column, 3);
  EXPECT_EQ(line_column({nullptr, 7}).line, 1);
}

TEST(ProblemText, NamesPlaceBlockPointerExpectedFoundAndHint) {
  Problem problem;
  problem.place = {source("axis.json", "{\n  \"Kp\": -1\n}"), 10};
  problem.pointer = "/blocks/feedback/Kp";
  problem.block = "stage.feedback";
  problem.message = "the number is out of range";
  problem.expected = "a number at least 0";
  problem.found = "-1";
  problem.hint = "gain on the position error";
  EXPECT_EQ(to_string(problem),
            "axis.json:2:9: error: the number is out of range\n"
            "  block: stage.feedback\n"
            "  at: /blocks/feedback/Kp\n"
            "  expected: a number at least 0\n"
            "  found: -1\n"
            "  hint: gain on the position error");
}

TEST(ProblemText, LeavesEmptyPartsOut) {
  Problem problem;
  problem.severity = Problem::Severity::warning;
  problem.message = "odd";
  EXPECT_EQ(to_string(problem), "warning: odd");
}

TEST(ProblemsText, SortsByFileAndPlaceAndCounts) {
  const auto a = source("a.json", "1\n2\n3\n"), b = source("b.json", "1\n");
  Problems problems;
  problems.error({b, 0}, "", "", "third");
  problems.error({a, 4}, "", "", "second");
  problems.warning({a, 0}, "", "", "first");
  EXPECT_EQ(problems.text(),
            "a.json:1:1: warning: first\n"
            "a.json:3:1: error: second\n"
            "b.json:1:1: error: third\n"
            "2 errors, 1 warning");
}

TEST(ProblemsText, IsEmptyWithoutProblems) { EXPECT_EQ(Problems().text(), ""); }

TEST(Problems, HaveErrorsOnlyWhenOneIsAnError) {
  Problems problems;
  problems.warning({}, "", "", "odd");
  EXPECT_FALSE(problems.has_errors());
  problems.error({}, "", "", "wrong");
  EXPECT_TRUE(problems.has_errors());
}

TEST(NearestName, FindsSlipsOfTheFinger) {
  const std::vector<std::string> names = {"damping", "mass", "sample_time", "Kp", "velocity"};
  EXPECT_EQ(nearest_name("dampnig", names), "damping");
  EXPECT_EQ(nearest_name("Mass", names), "mass");
  EXPECT_EQ(nearest_name("sampleTime", names), "sample_time");
  EXPECT_EQ(nearest_name("kp", names), "Kp");
  EXPECT_EQ(nearest_name("velocty", names), "velocity");
}

TEST(NearestName, OffersNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("banana", {"damping", "mass"}), "");
  EXPECT_EQ(nearest_name("", {"damping"}), "");
  EXPECT_EQ(nearest_name("damping", {}), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), {std::string(100000, 'x')}), "");
}

TEST(NearestName, PrefersTheSmallerMistake) {
  EXPECT_EQ(nearest_name("positon", {"position_2", "position", "pos"}), "position");
}

TEST(ProblemText, ShowsNoControlCharactersOfAFile) {
  EXPECT_EQ(printable("plain µ→𝄞\n"), "plain µ→𝄞\n");
  EXPECT_EQ(printable("\x1b[31mred\r\t\x7f"), "\\x1b[31mred\\x0d\\x09\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m")
      << "the other way to begin an escape sequence";
  EXPECT_EQ(printable("\xc2\xa0"), "\xc2\xa0");
  EXPECT_EQ(printable("\xff\xc0\xaf\xe0\x80\x80\xed\xa0\x80\xf4\x90\x80\x80\xc3"),
            "\\xff\\xc0\\xaf\\xe0\\x80\\x80\\xed\\xa0\\x80\\xf4\\x90\\x80\\x80\\xc3");
  Problems problems;
  problems.error({source("a\x1b.json", "{}"), 0}, "/x\x1b[2J", "b\x07", "m\x1b").found = "f\x1b]0;title\x07";
  EXPECT_EQ(problems.text().find_first_of("\x1b\x07"), std::string::npos) << problems.text();
}

TEST(ProblemText, TellsTwoHundredAndCountsTheOthers) {
  const auto file = source("a.json", std::string(1000, '\n'));
  Problems problems;
  for (uint32_t i = 0; i < 100'000; ++i) problems.warning({file, i % 900}, "", "", "doubtful");
  problems.error({file, 950}, "", "", "wrong");
  const std::string text = problems.text();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 201);
  EXPECT_NE(text.find("a.json:951:1: error: wrong\n"), text.npos) << "no error hides behind warnings";
  EXPECT_NE(text.find("\n… and 99,801 more\n1 error, 100,000 warnings"), text.npos)
      << text.substr(text.size() - 200);
}

}  // namespace
}  // namespace loopwright::problem_test
