// Values that a record is known to have: "set" of its experiment.
#include <gmock/gmock.h>
#include "tests/tools/experiment/experiment_folder.h"
#include "tools/compare/several.h"

namespace loopwright::own_values_test {
namespace {

using testing::HasSubstr, testing::Not;

constexpr double force_n = 4, noise_m = 1e-4;
double noise(double t) { return noise_m * (std::fmod(997 * t, 1) > 0.5 ? 1 : -1); }

/// A constant force moves 2 kg and what lies on them, from rest: x = F t² / (2 m).
class Loaded : public testing::Test {
 protected:
  Loaded() {
    folder.with("stage.json", R"({"loopwright": 1,
  "parameters": {"carriage": {"value": 2, "unit": "kg"}, "payload": {"value": 0, "unit": "kg"}},
  "solver": {"method": "rk4", "step": 0.05, "stop": 1},
  "blocks": {"push":  {"type": "Constant", "value": {"value": 0, "unit": "N"}},
             "stage": {"type": "Mass", "mass": "=carriage + payload", "initial_position": {"value": 0, "unit": "m"},
                       "in": {"force": "push.y"}}}})");
  }
  std::string record(const std::string& name, double mass, const std::string& set) {
    std::string text = "t,F,x\n";
    for (double t : every(0.05, 41))
      text += fmt::format("{:.17g},{},{:.17g}\n", t, force_n, force_n * t * t / (2 * mass) + noise(t + mass));
    folder.with(name + ".csv", text);
    const std::string own = set.empty() ? "" : ",\n  \"set\": {" + set + "}";
    folder.with(name + ".json", fmt::format(R"({{"loopwright": 1, "data": "{}.csv", "time": "t",
  "drive": {{"stage.force": {{"column": "F", "unit": "N"}}}},
  "compare": {{"stage.position": {{"column": "x", "unit": "m"}}}}{}}})",
                                            name, own));
    return folder.path(name + ".json");
  }
  std::string refusal(const std::vector<std::string>& records) {
    try {
      compare(folder.path("stage.json"), records);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  ExperimentFolder folder;
};

TEST_F(Loaded, EachRecordIsSimulatedWithItsOwn) {
  const std::string empty = record("empty", 2, "");
  for (const char* set :
       {R"("payload": {"value": 500, "unit": "g"})", R"("payload": "0.5 kg")", R"("payload": 0.5)",
        R"("payload": "=1/2")", R"("stage.mass": {"value": 2.5, "unit": "kg"})",
        R"("stage.payload": {"value": 0.5, "unit": "kg"})"}) {
    const std::string loaded = record("loaded", 2.5, set);
    for (const auto& order : {std::vector{empty, loaded}, std::vector{loaded, empty}})
      for (const Comparison& c : compare(folder.path("stage.json"), order).records)
        EXPECT_NEAR(c.signals[0].rmse, noise_m, 0.01 * noise_m) << set;
  }
  const auto untold = compare(folder.path("stage.json"), {empty, record("untold", 2.5, "")});
  EXPECT_GT(untold.records[1].signals[0].rmse, 1000 * noise_m);
}

TEST_F(Loaded, WhatTheRecordStatesReplacesWhatAllAreGiven) {
  LoadOptions heavier;
  heavier.set = {{"payload", "1 kg"}};
  const auto both = compare(folder.path("stage.json"),
                            {record("own", 2.5, R"("payload": 0.5)"), record("given", 3, "")}, heavier);
  for (const Comparison& c : both.records) EXPECT_NEAR(c.signals[0].rmse, noise_m, 0.01 * noise_m);
}

TEST_F(Loaded, EveryMistakeIsToldAtItsPlaceAtOnce) {
  const std::string text = refusal(
      {record("name", 2, R"("paylod": 1)"), record("unit", 2, R"("payload": {"value": 1, "unit": "m"})"),
       record("range", 2, R"("stage.payload": -3)"), record("path", 2, R"("stage..mass": 1)"),
       record("solver", 2, R"("solver.stop": 1)")});
  EXPECT_THAT(text, HasSubstr("name.json:4:21: error: there is no parameter or block \"paylod\""));
  EXPECT_THAT(text, HasSubstr("payload"));
  EXPECT_THAT(text, HasSubstr("unit.json:4:32: error: the unit does not fit"));
  EXPECT_THAT(text, HasSubstr("range.json:4:28: error: the number is out of range"));
  EXPECT_THAT(text, HasSubstr("path.json:4:11: error: \"stage..mass\" is no path"));
  EXPECT_THAT(text, HasSubstr("solver.json:4:11: error: a record has no solver of its own"));
  record("list", 2, "");
  folder.with("list.json", R"({"loopwright": 1, "data": "list.csv", "time": "t", "set": ["payload"],
    "compare": {"stage.position": {"column": "x", "unit": "m"}}})");
  EXPECT_THAT(refusal({folder.path("list.json")}), HasSubstr("expected: an object: path → value"));
}

}  // namespace
}  // namespace loopwright::own_values_test
