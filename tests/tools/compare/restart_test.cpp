// What hangs on the axis begins where the measured motion does, and anew with it.
#include <gtest/gtest.h>
#include "tests/tools/loaded_axis.h"
#include "tools/compare/compare.h"

namespace loopwright::restart_test {
namespace {

Comparison compared(const LoadedAxis& axis) {
  DiagramFolder folder;
  axis.write_to(folder);
  return compare(folder.path("axis.json"), folder.path("e.json"));
}

TEST(Restart, MovesALoadOnASpringWithTheAxis) {
  const Comparison with_more_damping = compared({.damping = 2.5});
  ASSERT_TRUE(with_more_damping.force) << with_more_damping.why_no_force;
  ASSERT_FALSE(with_more_damping.force->open_loop.restarted.empty());
  const auto& [horizon, error] = with_more_damping.force->open_loop.restarted.front();
  EXPECT_LT(error, 1e-3) << "what the damping leaves within " << horizon << " s";
}

/// The forces are to 5 N; a spring that began slack, or a load at rest, would swing with hundreds.
TEST(Restart, ALoadBeginsWhereTheRecordDoesAndAsFast) {
  const Comparison moving = compared({.velocity = 0.4});
  ASSERT_TRUE(moving.force) << moving.why_no_force;
  EXPECT_LT(moving.force->residual.rmse, 0.02);
}

}  // namespace
}  // namespace loopwright::restart_test
