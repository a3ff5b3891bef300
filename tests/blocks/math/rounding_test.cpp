#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::rounding_test {
namespace {

struct Case {
  const char* rule;
  double (*reference)(double);
};
const Case cases[] = {
    {"nearest", std::nearbyint}, {"floor", std::floor}, {"ceiling", std::ceil}, {"toward_zero", std::trunc}};

TEST(Rounding, IsThatOfTheCLibraryAndTellsEveryChange) {
  for (const Case& c : cases) {
    BlockUnderTest block("Rounding", fmt::format(R"({{"rule": "{}"}})", c.rule));
    for (int i = -40; i <= 40; ++i)
      for (const double nudge : {-1e-12, 0.0, 1e-12}) {
        const double u = i / 8.0 + nudge;
        block.input("u") = u;
        block.evaluate();
        ASSERT_EQ(block.output("y"), c.reference(u)) << c.rule << " of " << u;
        ASSERT_FALSE(std::signbit(block.output("y")) && block.output("y") == 0);
        for (int j = -40; j <= 40;
             ++j) {  // from here to anywhere: a crossing exactly where it is rounded otherwise
          const double to = j / 8.0 + nudge;
          block.input("u") = to;
          block.crossings();
          const bool is_inside = block.crossing("lower") > 0 && block.crossing("upper") < 0;
          ASSERT_EQ(is_inside, c.reference(to) == c.reference(u)) << c.rule << " from " << u << " to " << to;
        }
      }
  }
}

TEST(Rounding, RefusesLengths) {
  EXPECT_THAT(problems_of(diagram(R"("c": {"type": "Constant", "value": {"value": 5, "unit": "mm"}},
      "r": {"type": "Rounding", "in": {"u": "c.y"}})")),
              testing::HasSubstr("r.u"));
}

}  // namespace
}  // namespace loopwright::rounding_test
