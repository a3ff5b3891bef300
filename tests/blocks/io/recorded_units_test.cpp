// The unit of a recorded column reaches the wire, and its time is in the unit of its heading.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::recorded_units_test {
namespace {

const char* const amperes = "t,i [A],f,w [Hz]\n0,1,2,3\n1,1,2,3\n";
std::string column(const char* name, const char* more = "") {
  return fmt::format(R"("{0}": {{"type": "RecordedColumn", "file": "data.csv", "column": "{0}"{1}}})", name,
                     more);
}
std::string problems_with(const std::string& blocks) {
  DiagramFolder folder;
  folder.with("data.csv", amperes).with("top.json", diagram(blocks));
  return problems_in(folder);
}
const std::string newton = R"(, "n": {"type": "Constant", "value": {"value": 1, "unit": "N"}})";
std::string summed(const char* name) {
  return fmt::format(R"(, "sum": {{"type": "Sum", "in": {{"terms": ["{}.value", "n.y"]}}}})", name);
}

TEST(RecordedUnits, ACurrentIsNotSummedWithAForce) {
  EXPECT_TRUE(has(problems_with(column("i") + newton + summed("i")), "[A]"));
  EXPECT_TRUE(has(problems_with(column("f", R"(, "unit": "A")") + newton + summed("f")), "[A]"));
  EXPECT_EQ(problems_with(column("f", R"(, "unit": "kN")") + newton + summed("f")), "");
}

TEST(RecordedUnits, ACurrentIsNoForceOnAMass) {
  const std::string mass =
      R"(, "m": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "i.value"}})";
  EXPECT_TRUE(has(problems_with(column("i") + mass), "[A]"));
}

TEST(RecordedUnits, HertzAreNotTakenForRadiansPerSecond) {
  const std::string omega = R"(, "n": {"type": "Constant", "value": {"value": 1, "unit": "rad/s"}})";
  EXPECT_TRUE(has(problems_with(column("w") + omega + summed("w")), "Hz"));
}

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
}  // namespace loopwright::recorded_units_test
