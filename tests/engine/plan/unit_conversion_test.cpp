// Hz, rpm, rad/s … mean the same rotation wherever a quantity is given, or are rejected with both readings.
#include <gtest/gtest.h>
#include <numbers>
#include "engine/json/take_unit.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::unit_conversion_test {
namespace {

using std::numbers::pi;

struct RateUnit {
  std::string name;
  double radians_per_second;
  enum class Kind { cycles, radians, plain, scaled } kind;
};
using Kind = RateUnit::Kind;
const std::vector<RateUnit> rate_units = {
    {"Hz", 2 * pi, Kind::cycles}, {"kHz", 2000 * pi, Kind::cycles},   {"rpm", 2 * pi / 60, Kind::radians},
    {"rad/s", 1, Kind::radians},  {"deg/s", pi / 180, Kind::radians}, {"rev/s", 2 * pi, Kind::radians},
    {"1/s", 1, Kind::plain},      {"1/min", 1.0 / 60, Kind::scaled},  {"1/ms", 1000, Kind::scaled}};

/// Conversions are named while it lives, as by `check`.
struct ChangedReadings {
  ChangedReadings() { name_changed_readings(true); }
  ~ChangedReadings() { name_changed_readings(false); }
};

/// A parameter of a block that expects rad/s, Hz, or a plain 1/s.
struct Place {
  std::string block, path;
  RateUnit wants;
};
const std::vector<Place> places = {
    {R"("x": {"type": "LowPass", "cutoff": VALUE, "in": {"u": "t.time"}}, "t": {"type": "Clock"})",
     "cutoff",
     {"rad/s", 1, Kind::radians}},
    {R"("x": {"type": "Notch", "sample_time": 0.001, "frequency": VALUE, "width_damping": 0.5, "in": {"u": "t.time"}}, "t": {"type": "Clock"})",
     "frequency",
     {"rad/s", 1, Kind::radians}},
    {R"("x": {"type": "Sine", "frequency": VALUE})", "frequency", {"Hz", 2 * pi, Kind::cycles}},
    {R"("x": {"type": "Multisine", "components": [{"amplitude": 1, "frequency": VALUE}]})",
     "components.0.frequency",
     {"Hz", 2 * pi, Kind::cycles}},
    {R"("x": {"type": "PidController", "sample_time": 0.001, "Kp": 1, "Ki": 1, "Kd": 0, "derivative_pole": 100, "tracking_gain": VALUE, "in": {"reference": "t.time", "measured": "t.time"}}, "t": {"type": "Clock"})",
     "tracking_gain",
     {"1/s", 1, Kind::plain}},
};

std::string filled(std::string text, const std::string& value) {
  return text.replace(text.find("VALUE"), 5, value);
}

/// The number that the block uses, and the messages about it.
struct Outcome {
  std::optional<double> number;
  std::string problems;
};

Outcome outcome_of(const DiagramFolder& folder, const std::string& path, const LoadOptions& options = {}) {
  Problems problems;
  const auto diagram = load_diagram(folder.path("top.json"), options, problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  Outcome outcome{{}, problems.text()};
  if (!plan) return outcome;
  for (const Plan::Block& block : plan->blocks)
    if (block.path.ends_with("x")) {
      const double* number = block.type->kernels.tunable(const_cast<void*>(block.value.get()), path);
      if (number) outcome.number = *number;
    }
  return outcome;
}

/// All ways in which `value` with a unit reaches a parameter.
std::vector<std::pair<std::string, Outcome>> outcomes(const Place& place, const std::string& number,
                                                      const RateUnit& unit) {
  std::vector<std::pair<std::string, Outcome>> list;
  const std::string literal = R"({"value": )" + number + R"(, "unit": ")" + unit.name + "\"}";
  DiagramFolder folder;
  const auto add = [&](const std::string& way, const LoadOptions& options = {}) {
    list.emplace_back(way, outcome_of(folder, place.path, options));
  };
  const auto write = [&](const std::string& value, const std::string& more = "") {
    folder.with("top.json", diagram(filled(place.block, value), R"("stop": 1, "step": 0.1)", more));
  };
  write(literal);
  add("a literal");
  write("1");
  LoadOptions set;
  set.set.emplace_back("x." + place.path, number + " " + unit.name);
  add("--set", set);
  set.set[0].second = literal;
  add("--set with an object", set);
  write("\"=rate\"", R"(, "parameters": {"rate": )" + literal + "}");
  add("a parameter handed on", {});
  write("\"=rate\"", R"(, "parameters": {"first": )" + literal + R"(, "rate": "= first "})");
  add("a parameter handed on twice");
  write("\"=rate\"", R"(, "parameters": {"first": )" + literal +
                         R"(, "rate": {"value": "=first", "unit": ")" + place.wants.name + R"("}})");
  add("a parameter of the wanted unit");
  folder.with("inner.json",
              diagram(filled(place.block, "\"=rate\""), R"("stop": 1)",
                      R"(, "parameters": {"rate": {"value": 1, "unit": ")" + place.wants.name + R"("}})"));
  folder.with("top.json",
              diagram(R"("s": {"diagram": "inner.json", "parameters": {"rate": )" + literal + "}}"));
  add("a subdiagram's parameter");
  return list;
}

TEST(UnitConversion, GivesTheSameRotationOnEveryWayOrRefuses) {
  const ChangedReadings named;
  for (const Place& place : places)
    for (const RateUnit& unit : rate_units)
      for (const auto& [way, outcome] : outcomes(place, "40", unit)) {
        const std::string what = way + ": 40 " + unit.name + " for " + place.path + " in " +
                                 place.wants.name + "\n" + outcome.problems;
        const bool is_ambiguous = unit.kind == Kind::scaled
                                      ? place.wants.kind != Kind::plain
                                      : (unit.kind == Kind::cycles) != (place.wants.kind == Kind::cycles) &&
                                            (unit.kind == Kind::plain || place.wants.kind == Kind::plain);
        if (is_ambiguous) {
          EXPECT_FALSE(outcome.number) << what;
          EXPECT_TRUE(has(outcome.problems, "can mean two numbers here")) << what;
          EXPECT_TRUE(has(outcome.problems, "hint: ")) << what;
          continue;
        }
        ASSERT_TRUE(outcome.number) << what;
        const double expected = 40 * unit.radians_per_second / place.wants.radians_per_second;
        EXPECT_NEAR(*outcome.number / expected, 1, 1e-14) << what;
        const bool is_converted = (unit.kind == Kind::cycles) != (place.wants.kind == Kind::cycles);
        EXPECT_EQ(has(outcome.problems, "earlier versions read"), is_converted) << what;
      }
}

TEST(UnitConversion, NamesBothReadingsForAFrequency) {
  const std::string text = problems_of(
      diagram(R"("x": {"type": "Sine", "amplitude": 1, "frequency": {"value": 60, "unit": "1/min"}})"));
  EXPECT_TRUE(has(text, "as cycles it is 1 Hz, as radians 0.1592 Hz")) << text;
}

TEST(UnitConversion, NamesBothNumbersOfAFileThatChangesOnceAndOnlyWhereItIsWanted) {
  const std::string changed = diagram(
      R"("x": {"type": "LowPass", "cutoff": {"value": 40, "unit": "Hz"}, "in": {"u": "t.time"}}, "t": {"type": "Clock"})");
  const std::string warning = "warning: cutoff: 40 Hz is 251.3 rad/s; earlier versions read 40 rad/s";
  EXPECT_EQ(problems_of(changed), "");
  const ChangedReadings named;
  const std::string text = problems_of(changed);
  ASSERT_TRUE(has(text, warning)) << text;
  EXPECT_EQ(text.find(warning), text.rfind(warning)) << text;
}

TEST(UnitConversion, NamesBothReadingsOfWhatItRefuses) {
  const std::string text = problems_of(diagram(
      R"("x": {"type": "PidController", "sample_time": 0.001, "Kp": 1, "Ki": 1, "Kd": 0, "derivative_pole": 100, "tracking_gain": {"value": 40, "unit": "Hz"}, "in": {"reference": "t.time", "measured": "t.time"}}, "t": {"type": "Clock"})"));
  EXPECT_TRUE(has(text, "hint: counted once a cycle it is 40 1/s, in radians 251.3 rad/s")) << text;
}

/// A block's number from an expression over f = 40 Hz and w = 251 rad/s.
Outcome of_expression(const Place& place, const std::string& expression) {
  DiagramFolder folder;
  folder.with(
      "top.json",
      diagram(filled(place.block, "\"=" + expression + "\""), R"("stop": 1, "step": 0.1)",
              R"(, "parameters": {"f": {"value": 40, "unit": "Hz"}, "w": {"value": 251, "unit": "rad/s"},
                         "T": {"value": 0.5, "unit": "s"}, "v": "=2*pi*f"})"));
  return outcome_of(folder, place.path);
}

TEST(UnitConversion, LeavesExpressionsAsTheyAreToTheBit) {
  const Place &cutoff = places[0], &frequency = places[2], &plain = places[4];
  const double f = 40;
  const std::vector<std::tuple<const Place*, std::string, double>> silent = {
      {&cutoff, "2*pi*f", 2 * pi * f},
      {&cutoff, "f*2*pi", f * 2 * pi},
      {&cutoff, "v", 2 * pi * f},
      {&cutoff, "w/2", 251.0 / 2},
      {&cutoff, "1/T", 2},
      {&frequency, "2*f", 80},
      {&frequency, "w/(2*pi)", 251 / (2 * pi)},
      {&frequency, "1/T", 2},
      {&plain, "2*f", 80},
      {&plain, "w*2", 502}};
  for (const auto& [place, expression, expected] : silent) {
    const Outcome outcome = of_expression(*place, expression);
    EXPECT_EQ(outcome.problems, "") << expression;
    ASSERT_TRUE(outcome.number) << expression;
    EXPECT_EQ(*outcome.number, expected) << expression;
  }
}

TEST(UnitConversion, WarnsOfExpressionsThatSeemToBeInTheOtherUnit) {
  const Outcome doubled = of_expression(places[0], "2*f");
  EXPECT_EQ(doubled.number, 80.0);
  EXPECT_TRUE(has(doubled.problems, "cutoff: the expression seems to give 80 Hz, and is taken as 80 rad/s"))
      << doubled.problems;
  EXPECT_TRUE(has(doubled.problems, "80 Hz would be 502.7 rad/s")) << doubled.problems;
  const Outcome radians = of_expression(places[2], "2*pi*f");
  EXPECT_EQ(radians.number, 80 * pi);
  EXPECT_TRUE(has(radians.problems, "the expression seems to give 251.3 rad/s")) << radians.problems;
  EXPECT_TRUE(has(radians.problems, "251.3 rad/s would be 40 Hz: divide by 2*pi")) << radians.problems;
  const Outcome period = of_expression(places[2], "2*pi/T");
  EXPECT_EQ(period.number, 4 * pi);
  EXPECT_TRUE(has(period.problems, "the expression seems to give 12.57 rad/s, and is taken as 12.57 Hz"))
      << period.problems;
  EXPECT_EQ(of_expression(places[0], "2*pi/T").problems, "");
  const Outcome mixed = of_expression(places[0], "w + f");
  EXPECT_FALSE(mixed.number);
  EXPECT_TRUE(has(mixed.problems, "the expression adds Hz and rad/s")) << mixed.problems;
  EXPECT_EQ(of_expression(places[0], "w + 2*pi*f").problems, "");
}

TEST(UnitConversion, ATimeIsThePeriodOfAFrequency) {
  const auto sampled = [](std::string_view time) {
    return diagram(fmt::format(R"("t": {{"type": "Clock", "sample_time": "={}"}})", time), R"("stop": 1)",
                   R"(, "parameters": {"f": {"value": 40, "unit": "Hz"}, "w": {"value": 100, "unit": "rad/s"},
                      "n": {"value": 600, "unit": "rpm"}})");
  };
  EXPECT_EQ(plan_of(sampled("1/f"))->blocks[0].sample_time, 0.025);
  EXPECT_EQ(plan_of(sampled("1/w"))->blocks[0].sample_time, 0.01);
  EXPECT_EQ(plan_of(sampled("2*pi/n"))->blocks[0].sample_time, 0.1);
  EXPECT_EQ(plan_of(sampled("1/(f*(1 + 1))"))->blocks[0].sample_time, 0.0125);
  for (const char* wrong : {"2*pi/f", "pi/f", "2*pi*(1/f)", "1/(f/(2*pi))"}) {
    const std::string text = problems_of(sampled(wrong));
    EXPECT_TRUE(has(text, "2*pi over a frequency in Hz is neither a period nor a time constant")) << text;
    EXPECT_TRUE(has(text, "hint: the period of f is 1/f")) << text;
  }
  EXPECT_TRUE(has(problems_of(sampled("f")), "the unit does not fit \"sample_time\""));
}

TEST(UnitConversion, ANotchInHertzTakesThatFrequencyOut) {
  const RunResult result = run_of(diagram(
      R"("s":{"type":"Sine","frequency":40},
"n":{"type":"Notch","sample_time":0.0001,"frequency":{"value":40,"unit":"Hz"},"depth_damping":0,"width_damping":0.5,"in":{"u":"s.y"}},
"r":{"type":"Notch","sample_time":0.0001,"frequency":"=2*pi*40","depth_damping":0,"width_damping":0.5,"in":{"u":"s.y"}})",
      R"("method":"rk4","step":0.0001,"stop":1)"));
  EXPECT_EQ(signal(result, "n.y"), signal(result, "r.y"));
  EXPECT_LT(std::abs(signal(result, "n.y").back()), 1e-6);
}

TEST(UnitConversion, OfTemperaturesKnowsTheirZero) {
  const std::string blocks = R"("c": {"type": "Constant", "value": {"value": 20, "unit": "degC"}},
"s": {"type": "Step", "before": {"value": 68, "unit": "degF"}, "after": {"value": 300, "unit": "K"}, "time": 0.5},
"slope": {"type": "Ramp", "slope": {"value": 2, "unit": "degC/s"}})";
  const RunResult result = run_of(diagram(blocks));
  EXPECT_DOUBLE_EQ(signal(result, "c.y")[0], 293.15);
  EXPECT_NEAR(signal(result, "s.y")[0], 293.15, 1e-12);
  EXPECT_DOUBLE_EQ(signal(result, "slope.y").back(), 2);
  EXPECT_EQ(result.recording.columns[1].unit, "K");
}

TEST(UnitConversion, OfADifferenceOfTemperaturesTakesKelvin) {
  const auto amplitude = [](const std::string& value) {
    return problems_of(diagram(
        R"("s": {"type": "Sine", "frequency": 1, "bias": {"value": 20, "unit": "degC"}, "amplitude": )" +
            value + "}",
        R"("stop": 1)", R"(, "parameters": {"swing": {"value": 5, "unit": "degC"},
"cold": {"value": 5, "unit": "degC"}, "warm": {"value": 9, "unit": "degC"}})"));
  };
  EXPECT_EQ(amplitude(R"({"value": 5, "unit": "K"})"), "");
  EXPECT_EQ(amplitude("\"=warm - cold\""), "");
  for (const auto* point : {R"({"value": 5, "unit": "degC"})", "\"=swing\""})
    EXPECT_TRUE(has(amplitude(point), "a difference of temperatures is no temperature")) << amplitude(point);
}

TEST(UnitConversion, ShowsInThePlanWhatTheBlockReads) {
  const auto plan = plan_of(diagram(
      R"("m": {"type": "Multisine", "components": [{"amplitude": 1, "frequency": {"value": 60, "unit": "rpm"}}]},
"x": {"type": "LowPass", "cutoff": {"value": 40, "unit": "Hz"}, "in": {"u": "m.y"}})"));
  std::string all;
  for (const auto& [name, value] : plan->parameters) all += name + " = " + value + "\n";
  EXPECT_TRUE(has(all, "x.cutoff = 251.327412287183")) << all;
  EXPECT_TRUE(has(all, "rad/s")) << all;
  EXPECT_FALSE(has(all, "6.28")) << all;
}

}  // namespace
}  // namespace loopwright::unit_conversion_test
