#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::power_test {
namespace {

TEST(Power, IsThatOfTheCLibrary) {
  for (const double exponent : {-3.0, -0.5, 0.0, 0.37, 0.5, 1.0, 2.0, 3.0, 7.0, 100.5}) {
    BlockUnderTest block("Power", fmt::format(R"({{"exponent": {}}})", exponent));
    for (double u = 1e-2; u < 1e2; u *= 1.31)
      for (const double sign : {1.0, -1.0}) {
        if (sign < 0 && exponent != std::floor(exponent)) continue;
        block.input("u") = sign * u;
        block.evaluate();
        EXPECT_NEAR(block.output("y") / double(powl(sign * u, exponent)), 1, 5e-15) << u << "^" << exponent;
      }
    EXPECT_EQ(block.fault(), "") << exponent;
  }
}

TEST(Power, StopsWhereThereIsNone) {
  for (const auto& [u, exponent] : {std::pair(-1.0, 0.5), {0.0, -1.0}, {10.0, 400.0}}) {
    BlockUnderTest block("Power", fmt::format(R"({{"exponent": {}}})", exponent));
    block.input("u") = u;
    block.evaluate();
    EXPECT_EQ(block.fault(), "the power is not a finite number") << u << "^" << exponent;
  }
}

TEST(Power, HasThePowerOfTheUnit) {
  const auto unit = [](const char* block) {
    const auto plan = plan_of(diagram(fmt::format(
        R"("c": {{"type": "Constant", "value": {{"value": 4, "unit": "m/s"}}}}, "p": {{{}, "in": {{"u": "c.y"}}}})",
        block)));
    return to_string(plan->unit_of(plan->find("p.y")[0]).value());
  };
  EXPECT_EQ(unit(R"("type": "Power", "exponent": 2)"), "m^2/s^2");
  EXPECT_EQ(unit(R"("type": "Power", "exponent": -1)"), "s/m");
  EXPECT_NE(unit(R"("type": "SquareRoot")"), "m/s");
}

}  // namespace
}  // namespace loopwright::power_test
