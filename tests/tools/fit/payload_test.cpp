// One mass of a carriage from records with different payloads on it.
#include <gmock/gmock.h>
#include <cmath>
#include "models/random/philox.h"
#include "tests/engine/written_diagram.h"
#include "tools/fit/fit.h"

namespace loopwright::payload_fit_test {
namespace {

using testing::HasSubstr, testing::Not;

constexpr double carriage_kg = 2, damping = 3, noise_m = 1e-3;

/// (carriage + payload) x'' + b x' = sin 2t from rest, in closed form.
class Payloads : public testing::Test {
 protected:
  Payloads() {
    folder.with("axis.json", R"({
  "loopwright": 1,
  "parameters": {
    "carriage": {"value": 1.5, "unit": "kg"},
    "payload":  {"value": 0, "unit": "kg"},
    "damping":  {"value": 1, "unit": "N*s/m"}
  },
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "push":      {"type": "Constant", "value": {"value": 0, "unit": "N"}},
    "motor":     {"type": "Gain", "gain": 1, "in": {"u": "push.y"}},
    "viscous":   {"type": "ViscousFriction", "damping": "=damping", "in": {"velocity": "axis.velocity"}},
    "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
    "axis":      {"type": "Mass", "mass": "=carriage + payload", "in": {"force": "net_force.sum"}}
  }
}
)");
  }
  std::string record(const std::string& name, double payload, const std::string& set) {
    std::string text = "t,u,x\n";
    const double m = carriage_kg + payload, b = damping, w = 2, d = b * b + m * m * w * w;
    for (int k = 0; k <= 800; ++k) {
      const double t = 0.01 * k;
      const double x = b / d / w * (1 - std::cos(w * t)) - m / d * std::sin(w * t) +
                       m * w / d * m / b * (1 - std::exp(-b * t / m));
      const UniformPair u = uniform_pair(uint64_t(1000 * payload) + 1, 1, uint64_t(k));
      const double normal = std::sqrt(-2 * std::log(u.first)) * std::cos(2 * M_PI * u.second);
      text += fmt::format("{:.15g},{:.12g},{:.9g}\n", t, std::sin(w * t), x + noise_m * normal);
    }
    folder.with(name + ".csv", text);
    folder.with(name + ".json", fmt::format(R"({{"loopwright": 1, "data": "{}.csv", "time": "t",
      "drive": {{"motor.u": {{"column": "u", "unit": "N", "interpolation": "linear"}}}},
      "compare": {{"axis.position": {{"column": "x", "unit": "m"}}}}{}}})",
                                            name, set.empty() ? "" : ",\n\"set\": {" + set + "}"));
    return folder.path(name + ".json");
  }
  std::string refusal(const std::vector<std::string>& records, const std::vector<std::string>& parameters,
                      const FitOptions& options = {}) {
    try {
      fit(folder.path("axis.json"), records, parameters, {}, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  DiagramFolder folder;
};

TEST_F(Payloads, TheCarriageIsTheSameInAllRecords) {
  const std::vector<std::string> records{record("empty", 0, ""),
                                         record("loaded", 0.5, R"("payload": {"value": 500, "unit": "g"})"),
                                         record("full", 1, R"("payload": "=1")")};
  const Fit result = fit(folder.path("axis.json"), records, {"carriage", "damping"});
  EXPECT_TRUE(result.has_converged);
  const FittedParameter &mass = result.parameters[0], &drag = result.parameters[1];
  EXPECT_NEAR(mass.value, carriage_kg, 1.5 * (mass.high - mass.low));
  EXPECT_LT(mass.high - mass.low, 0.02);
  EXPECT_NEAR(drag.value, damping, 1.5 * (drag.high - drag.low));
  for (const FittedRecord& r : result.records) EXPECT_NEAR(r.signals[0].after, noise_m, 0.1 * noise_m);
  Problems problems;
  const std::string written = with_fitted_values(folder.path("axis.json"), result, problems);
  EXPECT_EQ(problems.text(), "");
  EXPECT_THAT(written, HasSubstr(R"("payload":  {"value": 0, "unit": "kg"})")) << "no record's own value";
  EXPECT_THAT(written, Not(HasSubstr("\"value\": 1.5, \"unit\": \"kg\"")));
}

TEST_F(Payloads, WhatARecordSetsIsNotFitted) {
  const std::string empty = record("empty", 0, ""), loaded = record("loaded", 0.5, R"("payload": 0.5)");
  const std::string text = refusal({empty, loaded}, {"payload"});
  EXPECT_THAT(text,
              HasSubstr("loaded.json:4:9: error: \"payload\" is to be fitted, and this record sets it"));
  EXPECT_THAT(text, HasSubstr("=carriage + payload"));
  const std::string whole = record("whole", 0.5, R"("axis.mass": 2.5)");
  EXPECT_THAT(refusal({empty, whole}, {"axis.mass"}), HasSubstr("this record sets it"));
  FitOptions of_each;
  of_each.of_each = {"payload"};
  EXPECT_THAT(refusal({empty, loaded}, {"carriage"}, of_each), HasSubstr("this record sets it"));
}

TEST_F(Payloads, AMistakeInOneRecordIsToldAtItsPlace) {
  const std::string text =
      refusal({record("empty", 0, R"("pay": 0)"), record("loaded", 0.5, R"("load": 0.5)")}, {"carriage"});
  EXPECT_THAT(text, HasSubstr("empty.json:4:16: error: there is no parameter or block \"pay\""));
  EXPECT_THAT(text, HasSubstr("loaded.json:4:17: error: there is no parameter or block \"load\""));
}

}  // namespace
}  // namespace loopwright::payload_fit_test
