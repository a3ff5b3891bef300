// The mistakes of a state machine. Its states and outputs are compared with a plain interpreter in
// tests/state_machines.
#include <gmock/gmock.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::state_machine_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A diagram with a machine of these states and a ramp in m as its input x.
std::string with_states(const std::string& states, const std::string& more = "") {
  return R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.1},
 "parameters": {"reach": {"value": 0.5, "unit": "m"}, "wait": {"value": 0.3, "unit": "s"}, "off": 0},
 "blocks": {
  "x": {"type": "Ramp", "slope": {"value": 1, "unit": "m/s"}},
  "machine": {"type": "StateMachine", "sample_time": 0.1, "inputs": ["x"],
   "outputs": [{"name": "speed", "unit": "m/s"}],
   "in": {"x": "x.y"},)" +
         more + R"( "states": [)" + states + "]}}}";
}

std::string problems_of_states(const std::string& states, const std::string& more = "") {
  return problems_of(with_states(states, more));
}

constexpr auto two_states =
    R"({"name": "a", "set": {"speed": 0}, "transitions": [{"when": "x > reach", "to": "b"}]},
 {"name": "b"})";

TEST(StateMachine, WithoutMistakesSaysNothing) { EXPECT_EQ(problems_of_states(two_states), ""); }

TEST(StateMachine, NamesTheLineAndColumnOfAMistakeInAGuard) {
  const std::string text = problems_of_states(R"(
{"name": "a", "set": {"speed": 0}, "transitions": [{"to": "a", "when": "x > reach + rech"}]})");
  EXPECT_THAT(text, HasSubstr("top.json:8:85:"));
  EXPECT_THAT(text, HasSubstr("the guard cannot be read"));
  EXPECT_THAT(text, HasSubstr("rech"));
  EXPECT_THAT(text, HasSubstr("it knows the names x, reach"));
}

TEST(StateMachine, ThePositionIsThatOfTheFileAfterADuration) {
  const std::string text = problems_of_states(R"(
{"name": "a", "set": {"speed": 0}, "transitions": [{"to": "a", "when": "after(300 ms) && rech"}]})");
  EXPECT_THAT(text, HasSubstr("top.json:8:90:"));
}

TEST(StateMachine, RefusesStatesThatDoNotExist) {
  const std::string text = problems_of_states(
      R"({"name": "alpha", "set": {"speed": 0}, "transitions": [{"to": "alhpa", "when": "x > reach"}]})");
  EXPECT_THAT(text, AllOf(HasSubstr("there is no state \"alhpa\""), HasSubstr("did you mean \"alpha\"?")));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "inside": "b"})"), HasSubstr("there is no state \"b\""));
  EXPECT_THAT(problems_of_states(two_states, R"("initial": "c",)"), HasSubstr("there is no state \"c\""));
  EXPECT_THAT(problems_of_states(""), HasSubstr("at least one state"));
  EXPECT_THAT(problems_of_states(R"({"name": "a"}, {"name": "a"})"), HasSubstr("used twice"));
  EXPECT_THAT(problems_of_states(R"({"name": "a b"})"), HasSubstr("cannot be the name of a state"));
}

TEST(StateMachine, RefusesNestingThatCannotBe) {
  EXPECT_THAT(
      problems_of_states(R"({"name": "c"}, {"name": "a", "inside": "b"}, {"name": "b", "inside": "a"})"),
      HasSubstr("inside each other in a circle"));
  EXPECT_THAT(
      problems_of_states(R"({"name": "a", "initial": "c"}, {"name": "b", "inside": "a"}, {"name": "c"})"),
      HasSubstr("\"c\" is not directly inside \"a\""));
}

TEST(StateMachine, RefusesConflictingPriorities) {
  const auto with_priorities = [](const char* first, const char* second) {
    return problems_of_states(std::string(R"({"name": "a", "set": {"speed": 0}, "transitions": [
      {"when": "x > reach", "to": "b")") +
                              first + R"x(}, {"when": "after(wait)", "to": "a")x" + second +
                              R"(}]}, {"name": "b"})");
  };
  EXPECT_THAT(with_priorities(R"(, "priority": 1)", R"(, "priority": 1)"),
              AllOf(HasSubstr("have the same priority"), HasSubstr("to \"b\" and to \"a\"")));
  EXPECT_THAT(with_priorities(R"(, "priority": 1)", ""), HasSubstr("has no priority, and others"));
  EXPECT_EQ(with_priorities(R"(, "priority": 2)", R"(, "priority": 1)"), "");
  EXPECT_EQ(with_priorities("", ""), "");
}

TEST(StateMachine, ComparesUnitsInGuards) {
  const auto guard = [](const char* when) {
    return problems_of_states(
        std::string(R"({"name": "a", "set": {"speed": 0}, "transitions": [{"to": "b", "when": ")") + when +
        R"("}]}, {"name": "b"})");
  };
  EXPECT_EQ(guard("x > reach && x < 3*reach || x > 0"), "");
  EXPECT_THAT(guard("x > 500"), AllOf(HasSubstr("mixes units"), HasSubstr("x in m"))) << "as in mm";
  EXPECT_THAT(guard("x > 0 && (x < wait)"), HasSubstr("mixes units"));
  EXPECT_THAT(guard("x > 0 && after(reach)"), HasSubstr("the duration is not a time"));
  EXPECT_THAT(guard("x > 0 && after(3 mm)"), HasSubstr("the duration is not a time"));
  EXPECT_THAT(guard("x > 0 && after(x)"), HasSubstr("depends on an input"));
  EXPECT_THAT(guard("x > 0 && after(-1 s)"), HasSubstr("negative"));
  EXPECT_THAT(guard("x > 0 && after(1 s"), HasSubstr("closing parenthesis"));
}

TEST(StateMachine, ValuesHaveTheUnitOfTheirOutput) {
  EXPECT_THAT(
      problems_of_states(
          R"({"name": "a", "set": {"speed": {"value": 3, "unit": "kg"}}, "transitions": [{"to": "a", "when": "x > reach"}]})"),
      HasSubstr("wrong unit"));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "set": {"sped": 0}})"),
              AllOf(HasSubstr("no output \"sped\""), HasSubstr("did you mean \"speed\"?")));
}

TEST(StateMachine, WarnsOfWhatIsNeverUsed) {
  EXPECT_THAT(problems_of_states(std::string(two_states) + R"(, {"name": "c"})"),
              HasSubstr("the state \"c\" cannot be reached"));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "set": {"speed": 0}, "transitions": [
     {"when": "x > reach", "to": "b"}, {"when": "off", "to": "c"}]}, {"name": "b"}, {"name": "c"})"),
              AllOf(HasSubstr("from \"a\" to \"c\" is never taken: its guard is always false"),
                    HasSubstr("the state \"c\" cannot be reached")));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "set": {"speed": 0}, "transitions": [
     {"to": "b"}, {"when": "x > reach", "to": "b"}]}, {"name": "b"})"),
              HasSubstr("never taken: the transition to \"b\" is tested before it and is always taken"));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "set": {"speed": 0}, "transitions": [
     {"when": "x > reach", "to": "b"}]}, {"name": "b"}, {"name": "in", "inside": "a", "transitions": [
     {"when": "x > reach", "to": "b"}]})"),
              HasSubstr("the transition of \"a\" to \"b\" is tested before it and has the same guard"));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "transitions": [{"when": "x > reach", "to": "a"}]})"),
              HasSubstr("no state sets the output \"speed\""));
  EXPECT_THAT(problems_of_states(R"({"name": "a", "set": {"speed": 1}})"),
              HasSubstr("no guard reads the input \"x\""));
}

TEST(StateMachine, StopsTheRunAtAGuardThatIsNotANumber) {
  const RunResult result = run_of(R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.1}, "blocks": {
    "x": {"type": "Ramp", "slope": 1},
    "machine": {"type": "StateMachine", "sample_time": 0.1, "inputs": ["x"], "in": {"x": "x.y"}, "states": [
      {"name": "a", "transitions": [{"when": "sqrt(0.45 - x) + 0", "to": "a"}]}]}}})");
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, AllOf(HasSubstr("machine"), HasSubstr("an input or a guard is not a number")));
}

TEST(StateMachine, ANumberForAnOutputThatIsNotInSiNeedsAUnit) {
  const auto machine = [](const char* unit, const char* value) {
    return fmt::format(R"({{"loopwright": 1, "solver": {{"stop": 1, "step": 0.1}}, "blocks": {{
      "machine": {{"type": "StateMachine", "sample_time": 0.1, "outputs": [{{"name": "x", "unit": "{}"}}],
        "states": [{{"name": "a", "set": {{"x": {}}}}}]}}}}}})",
                       unit, value);
  };
  EXPECT_THAT(problems_of(machine("mm", "5")),
              AllOf(HasSubstr("needs a unit, as it is in mm"), HasSubstr(R"({"value": 5, "unit": "mm"})")));
  EXPECT_THAT(problems_of(machine("rpm", "60")), HasSubstr("needs a unit, as it is in rpm"));
  EXPECT_THAT(problems_of(machine("degC", "0")), HasSubstr("needs a unit, as it is in degC"));
  for (const char* value : {"0", R"({"value": 5, "unit": "mm"})"})
    EXPECT_EQ(problems_of(machine("mm", value)), "");
  EXPECT_EQ(problems_of(machine("m", "5")), "");
  EXPECT_DOUBLE_EQ(signal(run_of(machine("mm", R"({"value": 5, "unit": "mm"})")), "machine.x").back(), 0.005);
}

TEST(StateMachine, ValuesCanBeSetAndSweptByTheirPaths) {
  DiagramFolder folder;
  folder.with("top.json", with_states(two_states));
  LoadOptions options;
  options.set = {{"machine.states.0.set.speed", "0.25"}};
  const auto plan = load_plan(folder.path("top.json"), options);
  loopwright::Run<double> run(*plan);
  run.evaluate(run.due(), true);
  EXPECT_EQ(run.number(plan->find("machine.speed").at(0)), 0.25);
  ASSERT_NE(run.parameter("machine.states.0.set.speed"), nullptr);
  *run.parameter("machine.states.0.set.speed") = 0.5;
  run.reset({});
  run.evaluate(run.due(), true);
  EXPECT_EQ(run.number(plan->find("machine.speed").at(0)), 0.5);
}

}  // namespace
}  // namespace loopwright::state_machine_test
