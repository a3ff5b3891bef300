#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::at_stop_test {
namespace {

TEST(AtStop, TheRunIsHandedOverAtItsStopTimeWithSignalsComputed) {
  for (const char* solver : {R"("stop": 2, "step": 0.5)", R"("stop": 2, "method": "dopri5")"}) {
    const auto plan = plan_of(diagram(R"("a": {"type": "Clock"})", solver));
    double time = 0, shown = 0;
    RunOptions options;
    options.at_stop = [&](loopwright::Run<double>& run) {
      time = run.now().time;
      shown = run.number(plan->find("a.time")[0]);
    };
    simulate(*plan, options);
    EXPECT_EQ(time, 2);
    EXPECT_EQ(shown, 2);
  }
}

}  // namespace
}  // namespace loopwright::at_stop_test
