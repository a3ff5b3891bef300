// Cells without a number belong to their column: the others can be used.
#include <gmock/gmock.h>

#include "parsed_csv.h"

namespace loopwright::csv_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(CsvHoles, BelongToTheirColumnAndHarmNoOther) {
  const Recording r = parse_right("t;x;note\n0;1;start\n1;;\n2;3;1e999\n3;nan;5\n", {.allow_holes = true});
  ASSERT_THAT(names(r), ElementsAre("t", "x", "note"));
  EXPECT_THAT(r.columns[0].values, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(r.columns[0].holes.count, 0u);
  EXPECT_THAT(r.columns[1].values, ElementsAre(1, testing::IsNan(), 3, testing::IsNan()));
  ASSERT_EQ(r.columns[1].holes.count, 2u);
  EXPECT_THAT(to_string(r.columns[1].holes.first[0]),
              HasSubstr("data.csv:3:3: error: column \"x\": an empty cell"));
  EXPECT_THAT(to_string(r.columns[1].holes.first[1]),
              HasSubstr("data.csv:5:3: error: column \"x\": not a finite"));
  EXPECT_THAT(r.columns[2].values, ElementsAre(testing::IsNan(), testing::IsNan(), testing::IsNan(), 5));
  EXPECT_EQ(r.columns[2].holes.count, 3u);
  EXPECT_THAT(to_string(r.columns[2].holes.first[0]), HasSubstr("data.csv:2:5"));
  EXPECT_THAT(to_string(r.columns[2].holes.first[0]), HasSubstr("found: start"));
}

TEST(CsvHoles, AreRefusedUnlessTheyAreAllowed) {
  EXPECT_THAT(problems_of("t;note\n0;start\n1;2\n"), HasSubstr("data.csv:2:3: error: column \"note\": text"));
  EXPECT_THAT(problems_of("t;note\n0;\n1;2\n", {.allow_not_finite = true}), HasSubstr("an empty cell"));
  // Mistakes of the table are no holes.
  EXPECT_THAT(problems_of("t;x\n0;1\n1\n", {.allow_holes = true}), HasSubstr("a row of another length"));
  EXPECT_THAT(problems_of("t;x\n0;\"a\n1;2\n", {.allow_holes = true}), HasSubstr("text where a number"));
}

TEST(CsvHoles, AreCountedBeyondTheFirst) {
  std::string text = "t,x\n";
  for (int i = 0; i < 100; ++i) text += "1,?\n";
  const Recording r = parse_right(text, {.allow_holes = true});
  EXPECT_EQ(r.columns[1].holes.count, 100u);
  EXPECT_EQ(r.columns[1].holes.first.size(), 20u);
}

TEST(CsvHoles, ALastColumnOfNothingIsLeftOut) {
  const Recording r = parse_right("t;x;\n0;1;\n1;2;\n", {.allow_holes = true});
  EXPECT_THAT(names(r), ElementsAre("t", "x"));
  for (const char* text : {"t;x;\n0;1;\n1;2;3\n", "t;x;\n0;1;\n1;2;a\n", "t;x;\n0;1;4\n1;2;3\n"})
    EXPECT_THAT(problems_of(text, {.allow_holes = true}),
                HasSubstr("data.csv:1:5: error: column 3 has no name"))
        << text;
}

TEST(CsvHoles, PointsInRemarksAreNoDecimalPoints) {
  const Recording r = parse_right("t;x;note\n0;1,5;z. B.\n1;2,25;\n", {.allow_holes = true});
  EXPECT_THAT(r.columns[1].values, ElementsAre(1.5, 2.25));
}

}  // namespace
}  // namespace loopwright::csv_test
