// The time of a recorded column is in the unit of its heading.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright {
namespace {

TEST(RecordedUnits, MillisecondsArePlayedInMilliseconds) {
  DiagramFolder folder;
  folder.with("ms.csv", "t [ms],x [mm]\n0,0\n1000,1\n2000,2\n");
  folder.with("top.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.5, "stop": 2}, "blocks": {
                "r": {"type": "RecordedColumn", "file": "ms.csv", "column": "x", "interpolation": "linear"}}})");
  const RunResult result = simulate(*load_plan(folder.path("top.json")));
  EXPECT_NEAR(signal(result, "r.value").back(), 2e-3, 1e-12);
  EXPECT_NEAR(signal(result, "r.value")[1], 0.5e-3, 1e-12);
}

}  // namespace
}  // namespace loopwright
