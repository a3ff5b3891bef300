#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::pmsm_test {
namespace {

constexpr const char* motor =
    R"({"resistance": 0.8, "inductance_d": 0.003, "inductance_q": 0.005, "flux": 0.06, "pole_pairs": 4})";

TEST(Pmsm, StandsStillAtTheCurrentsOfItsSteadyState) {
  // ω L i by hand: u_d = R i_d - ω_e L_q i_q, u_q = R i_q + ω_e (L_d i_d + ψ)
  BlockUnderTest block("Pmsm", motor);
  const double d = -2, q = 7, field = 4 * 150;
  block.state("current_d") = d, block.state("current_q") = q;
  block.input("velocity") = 150;
  block.input("voltage_d") = 0.8 * d - field * 0.005 * q;
  block.input("voltage_q") = 0.8 * q + field * (0.003 * d + 0.06);
  block.evaluate();
  block.derivatives();
  EXPECT_NEAR(block.rate("current_d"), 0, 1e-9);
  EXPECT_NEAR(block.rate("current_q"), 0, 1e-9);
  EXPECT_NEAR(block.output("torque"), 1.5 * 4 * (0.06 * q - 0.002 * d * q), 1e-12);
}

TEST(Pmsm, PowerAtTheTerminalsIsShaftPowerHeatAndStoredEnergy) {
  BlockUnderTest block("Pmsm", motor);
  for (int k = 0; k < 50; ++k) {
    const double d = std::sin(k), q = 3 * std::cos(2.0 * k), u_d = 10 * std::cos(3.0 * k),
                 u_q = 20 * std::sin(5.0 * k), velocity = 100 * std::sin(7.0 * k);
    block.state("current_d") = d, block.state("current_q") = q;
    block.input("velocity") = velocity, block.input("voltage_d") = u_d, block.input("voltage_q") = u_q;
    block.evaluate();
    block.derivatives();
    const double stored = 1.5 * (0.003 * d * block.rate("current_d") + 0.005 * q * block.rate("current_q"));
    EXPECT_NEAR(1.5 * (u_d * d + u_q * q), block.output("torque") * velocity + block.output("heat") + stored,
                1e-10);
  }
}

}  // namespace
}  // namespace loopwright::pmsm_test
