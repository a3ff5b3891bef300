#include "engine/json/json.h"
#include <cmath>
#include <gtest/gtest.h>

namespace loopwright::json_test {
namespace {

std::shared_ptr<const SourceFile> source(std::string text) {
  return std::make_shared<SourceFile>(SourceFile{"f.json", std::move(text)});
}

Value good(std::string text) {
  Problems problems;
  Value value = parse_json(source(std::move(text)), problems);
  EXPECT_EQ(problems.text(), "");
  return value;
}

std::string problem_in(std::string text) {
  Problems problems;
  const Value value = parse_json(source(std::move(text)), problems);
  EXPECT_EQ(value.kind, Value::Kind::null);
  return problems.text();
}

std::string at(const Place& place) {
  const auto [line, column] = line_column(place);
  return std::to_string(line) + ":" + std::to_string(column);
}

TEST(Json, GivesEveryValueAndNameItsPlaceAndPointer) {
  const Value root =
      good("{\n  \"a\" : [1, \"x\\\"]\", {\"b\":null}],\n  \"c/d~\": -2.5e3, \"µ\": true, \"z\": false }");
  ASSERT_EQ(root.members.size(), 4u);
  EXPECT_EQ(at(root.place), "1:1");
  const auto& a = root.members[0];
  EXPECT_EQ(at(a.place), "2:3");
  EXPECT_EQ(at(a.value.place), "2:9");
  EXPECT_EQ(at(a.value.items[0].place), "2:10");
  EXPECT_EQ(at(a.value.items[1].place), "2:13");
  EXPECT_EQ(at(a.value.items[2].place), "2:21");
  EXPECT_EQ(a.value.items[2].find("b")->value.place.pointer(), "/a/2/b");
  EXPECT_EQ(root.members[1].value.place.pointer(), "/c~1d~0");
  EXPECT_EQ(at(root.members[1].value.place), "3:11");
  EXPECT_EQ(at(root.members[2].place), "3:19");
  EXPECT_EQ(at(root.members[2].value.place), "3:24");
  EXPECT_EQ(at(root.members[3].value.place), "3:35");
}

TEST(Json, ReadsNumbersExactlyAndKnowsWholeOnes) {
  const Value list = good("[0, -0, 12, 0.1, 1e3, 1.7976931348623157e308, 5e-324, 18446744073709551616, -7]");
  EXPECT_TRUE(list.items[0].whole);
  EXPECT_TRUE(std::signbit(list.items[1].number));
  EXPECT_TRUE(list.items[2].whole);
  EXPECT_EQ(list.items[3].number, 0.1);
  EXPECT_FALSE(list.items[3].whole);
  EXPECT_FALSE(list.items[4].whole);
  EXPECT_EQ(list.items[5].number, 1.7976931348623157e308);
  EXPECT_EQ(list.items[6].number, 5e-324);
  EXPECT_EQ(list.items[7].number, 18446744073709551616.0);
  EXPECT_EQ(list.items[8].number, -7);
}

TEST(Json, ReadsEscapesAndAByteOrderMark) {
  EXPECT_EQ(good(R"("a\n\t\"\\\/\u00b5\ud834\udd1e")").text, "a\n\t\"\\/µ𝄞");
  const Value object = good("\xEF\xBB\xBF{\"a\": 1}");
  EXPECT_EQ(at(object.place), "1:1");
}

struct Golden {
  std::string text, problem;
};

TEST(JsonErrors, SayInPlainWordsWhatIsWrongAndWhere) {
  const Golden cases[] = {
      {"", "f.json:1:1: error: the file is empty\n  expected: a JSON object: { … }\n1 error"},
      {" \n\t ", "f.json:1:1: error: the file is empty\n  expected: a JSON object: { … }\n1 error"},
      {"{\n  \"a\": 1,\n}",
       "f.json:2:9: error: there is a comma after the last entry\n  expected: \"}\" without a comma\n  "
       "found: ,\n1 error"},
      {"[1, 2, ]",
       "f.json:1:6: error: there is a comma after the last entry\n  at: /2\n  expected: \"]\" without a "
       "comma\n  found: ,\n1 error"},
      {"{\"a\": 1\n \"b\": 2}",
       "f.json:2:2: error: a comma is missing before this\n  expected: \",\" or \"}\"\n  found: \"\n1 error"},
      {"[1 2]",
       "f.json:1:4: error: a comma is missing before this\n  at: /1\n  expected: \",\" or \"]\"\n  found: "
       "2\n1 error"},
      {"{\"a\" 1}",
       "f.json:1:6: error: a colon is missing after a member name\n  at: /a\n  expected: :\n  found: 1\n1 "
       "error"},
      {"{a: 1}",
       "f.json:1:2: error: a member name must stand in double quotes\n  expected: \"name\": value\n  found: "
       "a\n1 error"},
      {"{'a': 1}",
       "f.json:1:2: error: a member name must stand in double quotes\n  expected: \"name\": value\n  found: "
       "'\n1 error"},
      {"{\"a\": 'x'}",
       "f.json:1:7: error: a text must stand in double quotes\n  at: /a\n  expected: \"\n  found: '\n1 "
       "error"},
      {"{\"a\": rk4}",
       "f.json:1:7: error: this is not a value\n  at: /a\n  expected: a number, a text in quotes, true, "
       "false, [ or {\n  found: rk4\n  hint: a text stands in double quotes\n1 error"},
      {"{\"a\": }",
       "f.json:1:7: error: a value is missing\n  at: /a\n  expected: a number, a text in quotes, true, "
       "false, [ or {\n  found: }\n1 error"},
      {"{\"a\": \"abc\n}",
       "f.json:1:7: error: a text has no closing quote\n  at: /a\n  expected: a second \" in the same "
       "line\n1 error"},
      {"{\"a\n\": 1}",
       "f.json:1:2: error: a text has no closing quote\n  expected: a second \" in the same line\n1 error"},
      {"{\"a\": \"\\x41\"}",
       "f.json:1:8: error: an escape is not known\n  at: /a\n  expected: \\\", \\\\, \\/, \\b, \\f, \\n, "
       "\\r, \\t or \\u\n  found: \\x41\n1 error"},
      {"[\"\\ud834\"]",
       "f.json:1:3: error: an escape does not name a character\n  at: /0\n  expected: \\u and four "
       "hexadecimal digits\n  found: \\ud834\n1 error"},
      {"[\"a\tb\"]",
       "f.json:1:4: error: a tabulator stands inside a text\n  at: /0\n  expected: \\t\n1 error"},
      {"{\n \"a\": [1,\n  2",
       "f.json:3:4: error: the file ends too early\n  at: /a/2\n  expected: \"]\" for the \"[\" in line 2\n1 "
       "error"},
      {"{\"a\": 1",
       "f.json:1:8: error: the file ends too early\n  expected: \"}\" for the \"{\" in line 1\n1 error"},
      {"{\"a\": [1}",
       "f.json:1:9: error: the wrong bracket closes the list\n  at: /a/1\n  expected: ]\n  found: }\n1 "
       "error"},
      {"{} {}",
       "f.json:1:4: error: there is something after the end of the value\n  expected: the end of the file\n  "
       "found: {\n1 error"},
      {"{ // no\n}",
       "f.json:1:3: error: comments are not allowed\n  hint: a \"description\" can say it\n1 error"},
      {"[1e400]",
       "f.json:1:2: error: a number is too large\n  at: /0\n  expected: at most 1.7976931348623157e308\n  "
       "found: 1e400\n1 error"},
      {"[-1e999]",
       "f.json:1:2: error: a number is too large\n  at: /0\n  expected: at most 1.7976931348623157e308\n  "
       "found: -1e999\n1 error"},
      {"[.5]",
       "f.json:1:2: error: a number is not well formed\n  at: /0\n  expected: digits before and after the "
       "point, as in -0.5 or 1e-3\n  found: .5\n1 error"},
      {"[1.]",
       "f.json:1:2: error: a number is not well formed\n  at: /0\n  expected: digits before and after the "
       "point, as in -0.5 or 1e-3\n  found: 1.\n1 error"},
      {"[01]",
       "f.json:1:2: error: a number is not well formed\n  at: /1\n  expected: a decimal number without "
       "leading zeros\n  found: 01\n1 error"},
      {"[0x1F]",
       "f.json:1:2: error: a number is not well formed\n  at: /1\n  expected: a decimal number without "
       "leading zeros\n  found: 0x1F\n1 error"},
      {"[NaN]",
       "f.json:1:2: error: this is not a value\n  at: /0\n  expected: a number, a text in quotes, true, "
       "false, [ or {\n  found: NaN\n  hint: a text stands in double quotes\n1 error"},
      {"{\"a\": 1,\n \"b\": {\"c\": 1, \"c\": 2}, \"a\": 3}",
       "f.json:2:16: error: \"c\" is there twice\n  at: /b/c\n  hint: the first one is in line 2, column 8\n"
       "f.json:2:25: error: \"a\" is there twice\n  at: /a\n  hint: the first one is in line 1, column 2\n2 "
       "errors"},
      {"[\"µ\", \"\xff\"]",
       "f.json:1:8: error: this byte belongs to no character\n  expected: text in UTF-8\n  found: the byte "
       "0xFF\n1 error"},
      {std::string("[1]\0[2]", 7),
       "f.json:1:4: error: this byte belongs to no character\n  expected: text in UTF-8\n  found: the byte "
       "0x00\n1 error"},
      {"[\"\xc0\xaf\"]",
       "f.json:1:3: error: this byte belongs to no character\n  expected: text in UTF-8\n  found: the byte "
       "0xC0\n1 error"},
      {"[\"\xed\xa0\x80\"]",
       "f.json:1:3: error: this byte belongs to no character\n  expected: text in UTF-8\n  found: the byte "
       "0xED\n1 error"},
  };
  for (const Golden& golden : cases) EXPECT_EQ(problem_in(golden.text), golden.problem) << golden.text;
}

TEST(Json, APointerSaysNamesAsTheyAreMeant) {
  const Value root = good(
      "\xEF\xBB\xBF { \"\\u00b5\\ud83d\\ude00\\n\\\"/~\" : [ 1 , { \"{,:]\" : \"a,b\" , \"c\":null } ] }");
  const Value& list = root.members[0].value;
  const std::string name = "/\u00b5\U0001F600\n\"~1~0";
  EXPECT_EQ(root.place.pointer(), "");
  EXPECT_EQ(list.place.pointer(), name);
  EXPECT_EQ(root.members[0].place.pointer(), name);
  EXPECT_EQ(list.items[1].members[0].value.place.pointer(), name + "/1/{,:]");
  EXPECT_EQ(list.items[1].members[1].place.pointer(), name + "/1/c");
}

TEST(JsonErrors, NestingHasALimit) {
  const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(good(nested(64)).items.size(), 1u);
  const std::string problem = problem_in(nested(65));
  EXPECT_NE(problem.find("f.json:1:65: error: the values nest deeper than 64 levels"), std::string::npos)
      << problem;
  EXPECT_NE(problem_in(std::string(1'000'000, '[')), "");
  EXPECT_NE(problem_in([] {
              std::string s;
              for (int i = 0; i < 100000; ++i) s += "{\"a\":";
              return s;
            }()),
            "");
}

TEST(JsonErrors, SizeHasALimit) {
  EXPECT_NE(problem_in(std::string((64u << 20) + 1, ' ')).find("larger than 64 MB"), std::string::npos);
}

TEST(JsonErrors, MemoryHasALimit) {
  std::string many = "[1";
  for (int i = 0; i < 4'000'000; ++i) many += ",1";
  EXPECT_NE(problem_in(many + "]").find("too many values"), std::string::npos);
}

TEST(JsonErrors, ThousandsOfDuplicatesCostNoThousandsOfWalks) {
  std::string text = "{\"a\":1";
  for (int i = 0; i < 100'000; ++i) text += ",\"a\":1";
  const std::string problem = problem_in(text + "}");
  EXPECT_NE(problem.find("100 errors"), std::string::npos);
}

TEST(ReadSource, SaysWhyAFileCannotBeRead) {
  Problems problems;
  EXPECT_EQ(read_source("/no/such/file.json", {}, problems), nullptr);
  EXPECT_EQ(read_source("/tmp", {source("x"), 0}, problems), nullptr);
  EXPECT_EQ(
      problems.text(),
      "/no/such/file.json:1:1: error: the file \"/no/such/file.json\" cannot be read: there is no such file\n"
      "f.json:1:1: error: the file \"/tmp\" cannot be read: it is a folder\n2 errors");
}

TEST(ToJson, ReadsBackTheSame) {
  for (const auto* text : {R"({"a":[1,0.1,-2.5e-300,true,false,null,"x\n\"µ\u0001"],"b":{},"c":[]})", "1e+22",
                           "-0.5", "[[[]]]"}) {
    const std::string once = to_json(good(text));
    EXPECT_EQ(to_json(good(once)), once);
  }
  EXPECT_EQ(to_json(good(" { \"a\" : [ 1.0 , 0.1 ] } ")), "{\"a\":[1,0.1]}");
  EXPECT_EQ(good(to_json(good("0.30000000000000004"))).number, 0.30000000000000004);
}

}  // namespace
}  // namespace loopwright::json_test
