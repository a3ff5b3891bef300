// Maps of balances: an axis held step by step, here computed from independently written forces.
#include <gmock/gmock.h>
#include <fstream>
#include <numbers>
#include <sstream>
#include "tests/engine/written_diagram.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tools/compare/compare.h"
extern "C" {
#include "tests/hidden_effects/random.h"
}

namespace loopwright::map_test {
namespace {

using testing::AnyOf, testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty,
    testing::Not;

constexpr double step = 0.5e-3, resolution = 1e-6, turn = 2 * std::numbers::pi;

/// Forward and back over 0.3 m in steps of half a millimetre. Each position is read four times, with a
/// scatter of one count.
class HeldAxis : public DiagramFolder {
 public:
  using Force = std::function<double(double position, double direction)>;

  explicit HeldAxis(const Force& hidden) {
    with("axis.json", diagram(R"("push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
      "motor": {"type": "Gain", "gain": 1, "in": {"u": "push.y"}},
      "viscous": {"type": "ViscousFriction", "damping": {"value": 3, "unit": "N*s/m"}, "in": {"velocity": "stage.velocity"}},
      "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
      "stage": {"type": "Mass", "mass": {"value": 0.26, "unit": "kg"}, "in": {"force": "net_force.sum"}})",
                              R"("method": "rk4", "step": 0.001, "stop": 1)"));
    Random random = random_stream(7, "held axis");
    std::string text = "t,F,x\n";
    for (int k = 0; k < 1199; ++k) {
      const double direction = k < 600 ? 1 : -1, at = step * (k < 600 ? k : 1198 - k);
      for (int reading = 0; reading < 4; ++reading)
        text += fmt::format("{:.3f},{:.9g},{:.9g}\n", 0.4 * k + 0.01 * reading,
                            hidden(at, direction) + 0.004 * random_normal(&random),
                            at + resolution * random_below(&random, 2));
    }
    with("map.csv", text);
    experiment("\"rows\": \"balances\", ");
  }
  void experiment(const std::string& rows) {
    with("map.json", R"({"loopwright": 1, "title": "Held", "data": "map.csv", "time": "t", )" + rows +
                         R"("drive": {"motor.u": {"column": "F", "unit": "N"}},
      "compare": {"stage.position": {"column": "x", "unit": "m", "resolution": 1e-6}},
      "roles": {"position": "stage.position", "velocity": "stage.velocity", "force": "net_force.sum", "input": "motor.u"}})");
  }
  Diagnosis diagnosed(const std::string& improved = "") const {
    DiagnoseOptions options;
    if (!improved.empty()) options.improved_diagram = path(improved);
    return diagnose(path("axis.json"), {path("map.json")}, options);
  }
};

double cogging(double position) { return 0.2 * std::sin(turn * position / 0.0225 + 0.7); }

TEST(Map, CoggingAndDryFrictionAreNamedWithTheirNumbers) {
  const HeldAxis axis([](double x, double direction) { return cogging(x) + 0.05 * direction; });
  const Diagnosis d = axis.diagnosed("improved.json");
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("cogging", "coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "pitch", 0.0225, 1e-4, "m");
  expect_parameter(d.effects[1], "level", 0.05, 0.003, "N");
  EXPECT_THAT(to_text(d), HasSubstr("a map of balances has neither speeds nor times"));
  // The added effect is in the diagram now and is no longer missing.
  const Diagnosis again = diagnose(axis.path("improved.json"), {axis.path("map.json")});
  EXPECT_EQ(again.verdict, Verdict::nothing_missing) << to_text(again);
  EXPECT_NEAR(again.error_before, d.error_after, 0.1 * d.error_after);
}

TEST(Map, NothingIsMissingWhereOnlyNoiseHolds) {
  const HeldAxis axis([](double, double) { return 0.0; });
  const Diagnosis d = axis.diagnosed();
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
  EXPECT_THAT(names(d), IsEmpty());
}

/// The second map is read and balanced, but nothing of it is fitted.
TEST(Map, AnotherMapMayBeHeldOutAsAWhole) {
  HeldAxis axis([](double x, double direction) { return cogging(x) + 0.05 * direction; });
  std::string rows = "t,F,x\n";
  for (int k = 0; k < 1199; ++k) {
    const double direction = k < 600 ? 1 : -1, at = step * (k < 600 ? k : 1198 - k);
    rows += fmt::format("{:.3f},{:.9g},{:.9g}\n", 0.4 * k, cogging(at) + 0.05 * direction, at);
  }
  axis.with("other.csv", rows);
  std::stringstream experiment;
  experiment << std::ifstream(axis.path("map.json")).rdbuf();
  std::string text = experiment.str();
  text.replace(text.find("map.csv"), 7, "other.csv");
  text.replace(text.find("\"drive\""), 7, "\"hold_out\": {\"fraction\": 1}, \"drive\"");
  axis.with("other.json", text);
  const Diagnosis d = diagnose(axis.path("axis.json"), {axis.path("map.json"), axis.path("other.json")});
  EXPECT_THAT(names(d), ElementsAre("cogging", "coulomb_friction")) << to_text(d);
}

TEST(Map, WhatNoEffectExplainsGetsNoNameButItsVariable) {
  const HeldAxis axis([](double x, double) { return 0.3 * std::exp(-std::pow((x - 0.15) / 0.01, 2)); });
  const Diagnosis d = axis.diagnosed();
  EXPECT_THAT(d.verdict, AnyOf(Verdict::unexplained, Verdict::partly_explained)) << to_text(d);
  EXPECT_THAT(d.remainder_variables, ElementsAre("position"));
}

std::string refusal(const HeldAxis& axis) {
  try {
    axis.diagnosed();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Map, RowsOfAnotherKindAndTooFewStandsAreTold) {
  HeldAxis axis([](double x, double) { return cogging(x); });
  axis.experiment("\"rows\": \"balance\", ");
  EXPECT_THAT(refusal(axis), HasSubstr("\"balances\": places where the axis stood still"));
  axis.experiment("\"rows\": \"balances\", ");
  axis.with("map.csv", "t,F,x\n0,1,0\n1,1,0.001\n2,1,0.002\n");
  EXPECT_THAT(refusal(axis), HasSubstr("the axis stood at 3 places only"));
}

TEST(Map, IsNotMixedWithMotionAndNotSimulated) {
  const HeldAxis axis([](double x, double) { return cogging(x); });
  HeldAxis other([](double x, double) { return cogging(x); });
  other.experiment("");
  try {
    diagnose(axis.path("axis.json"), {axis.path("map.json"), other.path("map.json")});
    ADD_FAILURE() << "a map and a motion were taken together";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("maps of balances and records of motion are mixed"));
  }
  EXPECT_THROW(compare(axis.path("axis.json"), axis.path("map.json")), InputError);
}

}  // namespace
}  // namespace loopwright::map_test
