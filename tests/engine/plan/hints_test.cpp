// Suggestions for names that do not exist.
#include <gtest/gtest.h>
#include "engine/block/registry.h"
#include "engine/diagram/names_elsewhere.h"
#include "engine/json/unit_hint.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::hints_test {
namespace {

bool method_exists(std::string_view method) {
  return problems_of(diagram(R"("c": {"type": "Constant", "value": 1})",
                             fmt::format(R"("stop": 1, "method": "{}")", method)))
      .empty();
}

TEST(Hints, NamesOfOtherProgramsLeadToBlocksThatExist) {
  for (const auto& [written, block] :
       std::vector<std::pair<std::string, std::string>>{{"PID", "PidController"},
                                                        {"Transfer Fcn", "TransferFunction"},
                                                        {"TransferFcn", "TransferFunction"},
                                                        {"Mux", "Pack"},
                                                        {"Demux", "Unpack"},
                                                        {"Rotor", "Inertia"},
                                                        {"Abs", "Absolute"},
                                                        {"Trig", "Trigonometry"},
                                                        {"Sin", "Trigonometry"},
                                                        {"Sample and Hold", "SampleAndHold"},
                                                        {"Multiport Switch", "MultiportSwitch"},
                                                        {"AND", "Logic"},
                                                        {"Detect Rise Positive", "Edge"},
                                                        {"TON", "Timer"},
                                                        {"Chart", "StateMachine"},
                                                        {"Stateflow", "StateMachine"},
                                                        {"Gain1", "Gain"},
                                                        {"Integrator1/s", "Integrator"},
                                                        {"Transfer Fcn2", "TransferFunction"},
                                                        {"Sum 3", "Sum"},
                                                        {"1/z", "UnitDelay"},
                                                        {"Gian", "Gain"},
                                                        {"Sine Wave", "Sine"},
                                                        {"From Workspace", "RecordedColumn"}}) {
    const std::string hint = block_type_hint(written);
    EXPECT_TRUE(hint.starts_with("did you mean \"" + block + "\"")) << written << ": " << hint;
    EXPECT_TRUE(find_block(block)) << block;
  }
  EXPECT_TRUE(has(block_type_hint("Scope"), "\"log\"") && has(block_type_hint("Scope"), "--report"));
  EXPECT_TRUE(has(block_type_hint("ode45"), "dopri5"));
  EXPECT_TRUE(has(block_type_hint("Triggered Subsystem"), "triggered_by"));
  EXPECT_EQ(block_type_hint("Xyzzy"), "`loopwright blocks` lists all types");
}

TEST(Hints, MisspelledUnitsLeadToUnitsThatExist) {
  for (const auto& [written, meant] :
       std::vector<std::pair<std::string, std::string>>{{"Nm", "N*m"},
                                                        {"mNm", "mN*m"},
                                                        {"kNm", "kN*m"},
                                                        {"Nmm", "N*mm"},
                                                        {"Nms", "N*m*s"},
                                                        {"Nm/rad", "N*m/rad"},
                                                        {"Nms/rad", "N*m*s/rad"},
                                                        {"Nm/A", "N*m/A"},
                                                        {"kgm2", "kg*m^2"},
                                                        {"kgm^2", "kg*m^2"},
                                                        {"kgcm2", "kg*cm^2"},
                                                        {"gcm2", "g*cm^2"},
                                                        {"Vs", "V*s"},
                                                        {"Vs/rad", "V*s/rad"},
                                                        {"RPM", "rpm"},
                                                        {"Rpm", "rpm"},
                                                        {"RPM/V", "rpm/V"},
                                                        {"RPS", "rps"},
                                                        {"HZ", "Hz"},
                                                        {"hz", "Hz"},
                                                        {"khz", "kHz"},
                                                        {"Kg", "kg"},
                                                        {"kgs", "kg"},
                                                        {"rads/s", "rad/s"},
                                                        {"cts/rev", "count/rev"},
                                                        {"/s", "1/s"},
                                                        {"/min", "1/min"},
                                                        {"U/min", "rpm"}}) {
    EXPECT_FALSE(parse_unit(written)) << written;
    EXPECT_EQ(unit_hint(written), "did you mean \"" + meant + "\"?");
    EXPECT_TRUE(parse_unit(meant)) << meant;
  }
}

TEST(Hints, UsualNotationsOfUnitsNeedNone) {
  for (const auto& [written, unit] : std::vector<std::pair<std::string, std::string>>{
           {"Ohm", "ohm"},       {"ohms", "ohm"},    {"sec", "s"},      {"secs", "s"},
           {"msec", "ms"},       {"degrees", "deg"}, {"degree", "deg"}, {"°", "deg"},
           {"rad/sec", "rad/s"}, {"m/s2", "m/s^2"},  {"m/s²", "m/s^2"}, {"kg.m2", "kg*m^2"},
           {"kg m2", "kg*m^2"},  {"N.m", "N*m"},     {"N-m", "N*m"},    {"N·m", "N*m"},
           {"uN", "µN"},         {"μN", "µN"},       {"µm", "um"},      {"μm", "um"},
           {"newtons", "N"},     {"meters", "m"},    {"volts", "V"},    {"amps", "A"},
           {"rps", "rev/s"}})
    EXPECT_EQ(parse_unit(written), parse_unit(unit)) << written;
}

TEST(Hints, EveryBlockThatIsOfferedExists) {
  for (const NameElsewhere& entry : names_elsewhere()) {
    EXPECT_TRUE(entry.block.empty() || find_block(entry.block)) << entry.name << ": " << entry.block;
    EXPECT_FALSE(advice(entry).empty()) << entry.name;
    EXPECT_EQ(find_name_elsewhere(entry.name), &entry) << entry.name << " stands there twice";
    EXPECT_TRUE(entry.method.empty() || method_exists(entry.method)) << entry.name << ": " << entry.method;
  }
  EXPECT_GT(names_elsewhere().size(), 150u);
}

TEST(Hints, NoNameElsewhereIsThatOfAnotherBlockHere) {
  // A block that is called so here is meant, whatever the name means elsewhere.
  for (const auto& [type, block] : all_blocks()) {
    const NameElsewhere* const entry = find_name_elsewhere(type);
    const bool is_same = entry && plain_name(entry->name) == plain_name(type);
    EXPECT_TRUE(!is_same || entry->block == type) << type << " leads to " << entry->block;
  }
}

TEST(Hints, SolversOfOtherProgramsLeadToMethods) {
  for (const auto& [written, method] : std::vector<std::pair<std::string, std::string>>{
           {"ode45", "dopri5"}, {"ode15s", "cvode-bdf"}, {"ode4", "rk4"}, {"ode1", "euler"}}) {
    const std::string text = problems_of(diagram(R"("c": {"type": "Constant", "value": 1})",
                                                 fmt::format(R"("stop": 1, "method": "{}")", written)));
    EXPECT_TRUE(has(text, "did you mean \"" + method + "\"?")) << text;
  }
}

TEST(Hints, ABlockInThePlaceOfItsOutputOffersThem) {
  const std::string wired = problems_of(diagram(R"("pd": {"type": "Gain", "gain": 1, "in": {"u": "c.y"}},
  "c": {"type": "Constant", "value": 1}, "g": {"type": "Gain", "gain": 1, "in": {"u": "pd"}})"));
  EXPECT_TRUE(has(wired, "did you mean \"pd.y\"?")) << wired;
  const std::string logged =
      problems_of(diagram(R"("two": {"type": "Mass", "mass": 1, "in": {"force": "c.y"}},
  "c": {"type": "Constant", "value": 1})",
                          R"("stop": 1, "step": 0.1)", R"(, "log": ["two"])"));
  EXPECT_TRUE(has(logged, "\"two.position\" or \"two.velocity\" or \"two.acceleration\"")) << logged;
}

TEST(Hints, TheSettingThatAsksForWiresIsNamed) {
  const std::string sum = problems_of(diagram(R"("c": {"type": "Constant", "value": 1},
  "s": {"type": "Sum", "signs": "+-", "in": {"terms": ["c.y"]}})"));
  EXPECT_TRUE(has(sum, "\"signs\": \"+-\" asks for 2 wires")) << sum;
}

TEST(Hints, UnitsWrittenNearlySo) {
  for (const auto& [written, meant] : std::vector<std::pair<std::string, std::string>>{{"Kg", "kg"},
                                                                                       {"kgs", "kg"},
                                                                                       {"Nm", "N*m"},
                                                                                       {"n", "N"},
                                                                                       {"RPM", "rpm"},
                                                                                       {"sec", "s"},
                                                                                       {"Kg*m/s", "kg*m/s"},
                                                                                       {"v/A", "V/A"}})
    EXPECT_EQ(unit_hint(written), "did you mean \"" + meant + "\"?") << written;
  EXPECT_EQ(unit_hint("furlongs per fortnightly"), "");
  const std::string text =
      problems_of(diagram(R"("m": {"type": "Constant", "value": {"value": 1, "unit": "Kg"}})"));
  EXPECT_TRUE(has(text, "did you mean \"kg\"?")) << text;
}

}  // namespace
}  // namespace loopwright::hints_test
