#include <gmock/gmock.h>
#include <algorithm>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::logic_test {
namespace {

/// The answer of an operator about a number of true terms among all, as a table in a textbook has it.
bool expected(const std::string& what, int trues, int all) {
  if (what == "and") return trues == all;
  if (what == "or") return trues > 0;
  if (what == "xor") return trues % 2 == 1;
  if (what == "nand") return trues < all;
  if (what == "nor") return trues == 0;
  return trues % 2 == 0;
}

TEST(Logic, HasTheTruthTableOfItsOperator) {
  for (const std::string what : {"and", "or", "xor", "nand", "nor", "xnor"})
    for (int all : {1, 2, 3, 5}) {
      BlockUnderTest logic("Logic", R"({"operator": ")" + what + "\"}");
      for (int pattern = 0; pattern < 1 << all; ++pattern) {
        auto& terms = logic.inputs("terms");
        terms.clear();
        for (int i = 0; i < all; ++i) terms.push_back(pattern >> i & 1);
        logic.evaluate();
        const int trues = int(std::ranges::count(terms, 1.0));
        EXPECT_EQ(logic.output("y"), expected(what, trues, all)) << what << " of pattern " << pattern;
      }
    }
}

TEST(Logic, NotHasOneTerm) {
  BlockUnderTest logic("Logic", R"({"operator": "not"})");
  for (const double u : {0.0, 1.0}) {
    logic.input("terms") = u;
    logic.evaluate();
    EXPECT_EQ(logic.output("y"), 1 - u);
  }
  EXPECT_THAT(problems_of(diagram(R"("c": {"type": "Constant", "value": 1},
      "n": {"type": "Logic", "operator": "not", "in": {"terms": ["c.y", "c.y"]}})")),
              testing::HasSubstr("1 wires"));
}

TEST(Logic, IsTrueAboveOneHalf) {
  BlockUnderTest logic("Logic", R"({"operator": "or"})");
  for (const auto& [u, y] : {std::pair(0.5, 0.0), {std::nextafter(0.5, 1.0), 1.0}, {-3.0, 0.0}, {5.0, 1.0}}) {
    logic.inputs("terms") = {0.0, u};
    logic.evaluate();
    EXPECT_EQ(logic.output("y"), y) << u;
    logic.crossings();
    EXPECT_EQ(logic.crossing("change") > 0, y > 0) << u;
  }
}

TEST(Logic, ANaNIsNeitherTrueNorFalse) {
  for (const char* what : {"and", "or", "xor", "nand", "nor", "xnor"}) {
    BlockUnderTest logic("Logic", R"({"operator": ")" + std::string(what) + "\"}");
    logic.inputs("terms") = {1.0, std::nan(""), 0.0};
    logic.evaluate();
    EXPECT_THAT(std::string(logic.fault()), testing::HasSubstr("neither true nor false")) << what;
  }
}

TEST(Logic, RefusesAVoltage) {
  const std::string text =
      problems_of(diagram(R"("five": {"type": "Constant", "value": {"value": 5, "unit": "V"}},
      "n": {"type": "Logic", "operator": "not", "in": {"terms": "five.y"}})"));
  EXPECT_THAT(text, testing::HasSubstr("n.terms")) << text;
}

TEST(Logic, SwitchesAtTheExactInstantOfAContinuousTerm) {
  // sin t passes one half at π/6 and 5π/6, the negation of 2 sin² t's excess over one half at other times.
  const RunResult result =
      run_of(diagram(R"("wave": {"type": "Sine", "amplitude": 1, "frequency": {"value": 1, "unit": "rad/s"}},
      "late": {"type": "Step", "time": 0.25},
      "both": {"type": "Logic", "operator": "and", "in": {"terms": ["wave.y", "late.y"]}},
      "time": {"type": "Integrator", "in": {"u": "rate.y"}},
      "rate": {"type": "Gain", "gain": {"value": 1, "unit": "1/s"}, "in": {"u": "both.y"}})",
                     R"("method": "dopri5", "stop": 6, "relative_tolerance": 1e-9)"));
  EXPECT_NEAR(signal(result, "time.y").back(), 5 * pi / 6 - pi / 6, 1e-9);
}

}  // namespace
}  // namespace loopwright::logic_test
