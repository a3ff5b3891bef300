// Mistakes about subdiagrams that do not always run. What they compute is compared with plain Python in
// tests/state_machines.
#include <gmock/gmock.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::gates_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A subdiagram with these blocks and an input u, and a logic signal "on.y".
std::string with_part(
    const std::string& condition, const std::string& blocks, const std::string& outputs = "",
    const std::string& on = R"({"type": "PulseTrain", "period": 0.4, "width": 0.2, "sample_time": 0.1})") {
  return diagram(R"("on": )" + on + R"(,
    "u": {"type": "Clock"},
    "part": {"in": {"u": "u.time"}, )" +
                 condition + R"(, "diagram": {"inputs": {"u": ""}, "blocks": {)" + blocks +
                 R"(}, "outputs": {)" + outputs + "}}}");
}
constexpr auto enabled = R"("enabled_by": "on.y")";
constexpr auto triggered = R"("triggered_by": "on.y")";
constexpr auto delay = R"("d": {"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "u"}})";

TEST(Gates, RefusesWrongKeys) {
  const auto text = [](const std::string& condition) { return problems_of(with_part(condition, delay)); };
  EXPECT_THAT(text(R"("enabled_by": 3)"), HasSubstr("\"enabled_by\""));
  EXPECT_THAT(text(R"("enabled_by": "of.y")"),
              AllOf(HasSubstr("no block \"of\""), HasSubstr("did you mean \"on\"?")));
  EXPECT_THAT(text(R"("enabled_by": "on.y", "triggered_by": "on.y")"),
              HasSubstr("either enabled or triggered"));
  EXPECT_THAT(text(R"("enabled_by": "on.y", "while_disabled": "stop")"),
              AllOf(HasSubstr("neither held nor reset"), HasSubstr("\"hold\" or \"reset\"")));
  EXPECT_THAT(text(R"("enabled_by": "on.y", "while_disabled": {"state": "hold"})"), HasSubstr("state"));
  EXPECT_THAT(text(R"("enabled_by": "on.y", "edge": "rising")"), HasSubstr("belongs to \"triggered_by\""));
  EXPECT_THAT(text(R"("triggered_by": "on.y", "while_disabled": "hold")"),
              HasSubstr("belongs to \"enabled_by\""));
  EXPECT_THAT(text(R"("triggered_by": "on.y", "edge": "up")"), HasSubstr("there is no such edge"));
  EXPECT_THAT(text(R"("enable_by": "on.y")"), HasSubstr("did you mean \"enabled_by\""));
}

TEST(Gates, RefusesWhatCannotStopAndStartAgain) {
  EXPECT_THAT(
      problems_of(with_part(enabled, R"("d": {"type": "TransportDelay", "delay": 0.2, "in": {"u": "u"}})")),
      HasSubstr("cannot stop and start again"));
  EXPECT_THAT(problems_of(with_part(triggered, R"("x": {"type": "Integrator", "in": {"u": "u"}})")),
              HasSubstr("has no meaning in a subdiagram that is triggered"));
}

TEST(Gates, RefusesTriggersThatWouldBeMissed) {
  EXPECT_THAT(problems_of(with_part(triggered,
                                    R"("d": {"type": "UnitDelay", "sample_time": 0.2, "in": {"u": "u"}})")),
              AllOf(HasSubstr("would miss triggers"), HasSubstr("0.1 s")));
  EXPECT_THAT(
      problems_of(with_part(triggered, delay, "", R"({"type": "PulseTrain", "period": 0.4, "width": 0.2})")),
      HasSubstr("a trigger must be a sampled signal"));
}

TEST(Gates, RefusesAnOutputThatWouldNotBeHeld) {
  EXPECT_THAT(problems_of(with_part(enabled, delay, R"("through": "u")")), HasSubstr("would not be held"));
  EXPECT_EQ(problems_of(with_part(std::string(enabled) + R"(, "while_disabled": "reset")", delay,
                                  R"("through": "u")")),
            "");
}

TEST(Gates, RefusesTheNameOfItsOwnSignal) {
  EXPECT_THAT(problems_of(with_part(enabled, R"("enabled": {"type": "Gain", "gain": 1, "in": {"u": "u"}})")),
              HasSubstr("the name \"enabled\" is in use"));
}

TEST(Gates, RefusesAConditionOnItsOwnOutput) {
  const std::string text = problems_of(diagram(R"("u": {"type": "Constant", "value": 1},
    "part": {"in": {"u": "u.y"}, "enabled_by": "part.y",
             "diagram": {"inputs": {"u": ""}, "blocks": {"g": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}, "outputs": {"y": "g.y"}}})"));
  EXPECT_THAT(text, AllOf(HasSubstr("algebraic loop"), HasSubstr("which it enables")));
}

TEST(Gates, RefusesAVectorAsItsCondition) {
  const std::string text = problems_of(diagram(
      R"("u": {"type": "Constant", "value": 1}, "p": {"type": "Pack", "in": {"elements": ["u.y", "u.y"]}},
    "part": {"in": {"u": "u.y"}, "enabled_by": "p.y",
             "diagram": {"inputs": {"u": ""}, "blocks": {"g": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}, "outputs": {"y": "g.y"}}})"));
  EXPECT_THAT(text, HasSubstr("takes one logic value"));
}

TEST(Gates, ContentsOfVectorsAreHeldByElement) {
  const RunResult result =
      run_of(diagram(R"("on": {"type": "Step", "time": 0.35, "before": 1, "after": 0, "sample_time": 0.1},
    "u": {"type": "Clock"}, "v": {"type": "Gain", "gain": 2, "in": {"u": "u.time"}},
    "p": {"type": "Pack", "in": {"elements": ["u.time", "v.y"]}},
    "part": {"in": {"u": "p.y"}, "enabled_by": "on.y", "while_disabled": {"outputs": "hold"},
             "diagram": {"inputs": {"u": ""}, "blocks": {"d": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "u"}}},
                         "outputs": {"y": "d.y"}}})",
                     R"("stop": 1, "step": 0.1)", R"(, "log": ["part.y"])"));
  EXPECT_EQ(signal(result, "part.y[0]").back(), 0.3);
  EXPECT_EQ(signal(result, "part.y[1]").back(), 0.6);
}

}  // namespace
}  // namespace loopwright::gates_test
