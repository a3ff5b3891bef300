// Effects that act at a site of any diagram: their files.
#include <gmock/gmock.h>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/effects/effect.h"
#include "tools/effects/site_effect.h"
#include "where.h"

namespace loopwright::site_effect_test {
namespace {

constexpr const char* weir = R"({
  "loopwright": 1, "effect": "weir", "title": "Flow over a weir", "physics": "Water above the crest runs off.",
  "site": "flow", "of": ["level", "position"],
  "parameters": {
    "crest": {"unit": "$signal", "range": ["=lowest_signal", "=highest_signal"], "points": 4},
    "width": {"unit": "$site/$signal^1.5", "linear": true}
  },
  "formula": "width*max(0, signal - crest)^1.5"
})";

TEST(SiteEffect, SaysWhereItActsOnWhatItDependsAndHow) {
  DiagramFolder folder;
  folder.with("weir.json", weir);
  Problems problems;
  const auto effect = load_site_effect(folder.path("weir.json"), problems);
  ASSERT_TRUE(effect) << problems.text();
  EXPECT_THAT(effect->sites, testing::ElementsAre("flow"));
  EXPECT_THAT(effect->signals, testing::ElementsAre("level", "position"));
  EXPECT_EQ(effect->parameters[0].name, "width") << "linear ones are the first";
  EXPECT_EQ(effect->parameters[0].power, 1.5);
  const SignalRange range = range_of(effect->parameters[1], {.lowest = 0.2, .highest = 0.7});
  EXPECT_EQ(range.low, 0.2);
  EXPECT_EQ(range.high, 0.7);
}
TEST(SiteEffect, IsNoEffectOfAnAxisNorTheReverse) {
  DiagramFolder folder;
  folder.with("weir.json", weir);
  Problems problems;
  EXPECT_TRUE(load_catalogue({folder.path("")}, problems).empty());
  EXPECT_TRUE(load_site_effects({LOOPWRIGHT_SOURCE "/diagrams/effects"}, problems).empty());
  EXPECT_EQ(problems.text(), "");
}
TEST(SiteEffect, AllMistakesAreReportedAtOnce) {
  DiagramFolder folder;
  folder.with("wrong.json", R"({
  "loopwright": 1, "effect": "other", "title": "Wrong", "physics": "Nothing.",
  "site": "flwo", "of": ["level", "spped"], "extra": 1,
  "parameters": {
    "crest": {"unit": "$site", "range": ["=lowest_signl", 1]},
    "size": {"unit": "$signal", "linear": true},
    "wide": {"unit": "$signal", "range": [2, 1], "scale": "loagrithmic"},
    "none": {"unit": "$signal"}
  },
  "formula": "size*signal"
})");
  Problems problems;
  EXPECT_FALSE(load_site_effect(folder.path("wrong.json"), problems));
  for (const char* part :
       {"/extra", "no signal is of the kind \"flwo\"", "did you mean \"flow\"",
        "no signal is of the kind \"spped\"", "the parameter cannot have this unit",
        "there is no size \"lowest_signl\"", "did you mean \"lowest_signal\"", "the range is empty",
        "did you mean \"logarithmic\"", "the parameter \"none\" has no \"range\"", "a file of another name"})
    EXPECT_THAT(problems.text(), testing::HasSubstr(part));
}

std::string problems_of(const std::string& parameters, const std::string& formula, const std::string& of) {
  DiagramFolder folder;
  folder.with("own.json", R"({"loopwright": 1, "effect": "own", "title": "", "physics": "", "site": "any",
  "of": )" + (of.starts_with('[') ? of : '"' + of + '"') +
                              R"(, "parameters": {)" + parameters + R"(}, "formula": ")" + formula + "\"}");
  Problems problems;
  EXPECT_FALSE(load_site_effect(folder.path("own.json"), problems));
  return problems.text();
}
std::string problems_of_good(const std::string& parameters, const std::string& formula) {
  DiagramFolder folder;
  folder.with("own.json", R"({"loopwright": 1, "effect": "own", "title": "T", "physics": "P", "site": "any",
  "of": "any", "parameters": {)" +
                              parameters + R"(}, "formula": ")" + formula + "\"}");
  Problems problems;
  EXPECT_TRUE(load_site_effect(folder.path("own.json"), problems));
  return problems.text();
}
constexpr const char* size = R"("size": {"unit": "$site", "linear": true})";
constexpr const char* knee = R"("knee": {"unit": "$signal", "range": [0.1, "=largest_signal"]})";

TEST(SiteEffect, ItsFormulaIsReadAndProportionalToItsLinearParameters) {
  EXPECT_THAT(problems_of(size, "size*exp(signal", "any"), testing::HasSubstr("the formula cannot be read"));
  EXPECT_THAT(problems_of(size, "size*exp(sginal)", "any"),
              testing::HasSubstr("it knows the name signal, size"));
  EXPECT_THAT(problems_of(size, "size^2*signal", "any"),
              testing::HasSubstr("not proportional to its linear parameters"));
  EXPECT_THAT(problems_of(size, "size + signal", "any"),
              testing::HasSubstr("not proportional to its linear parameters"));
  EXPECT_THAT(problems_of(size, "abs(size)*signal", "any"),
              testing::HasSubstr("not proportional to its linear parameters"));
  EXPECT_THAT(problems_of(knee, "tanh(signal/knee)", "any"), testing::HasSubstr("no linear parameter"));
  EXPECT_THAT(problems_of(size, "size*signal", "site"), testing::HasSubstr("a distortion has no linear"));
}

TEST(SiteEffect, ItsFormulaHasTheUnitOfTheSite) {
  constexpr const char* by_square = R"("size": {"unit": "$site/$signal^2", "linear": true})";
  EXPECT_THAT(problems_of(size, "size*signal*abs(signal)", "any"),
              testing::HasSubstr("units of the formula"));
  EXPECT_THAT(problems_of(size, "size*exp(signal)", "any"), testing::HasSubstr("units of the formula"));
  EXPECT_THAT(problems_of(by_square, "size*(signal - 0.3)^2", "any"),
              testing::HasSubstr("units of the formula"));
  for (const auto& [parameters, formula] :
       {std::pair<std::string, const char*>{by_square, "size*signal*abs(signal)"},
        {R"("size": {"unit": "$site/$signal^0.5", "linear": true})", "size*sqrt(signal)"},
        {std::string(size) + ", " + knee, "size*tanh(signal/knee)"}})
    EXPECT_EQ(problems_of_good(parameters, formula), "") << formula;
  EXPECT_THAT(problems_of(R"("size": {"unit": "$site", "linear": true, "range": [0, 1]})",
                          "size*sign(signal)", "any"),
              testing::HasSubstr("a linear parameter has no \"range\""));
}

TEST(SiteEffect, DependsOnItsOwnSignalOrOnOthers) {
  for (const char* of : {R"(["site", "force"])", R"(["any", "site"])", R"(["site", "site"])"})
    EXPECT_THAT(problems_of(size, "size*signal", of), testing::HasSubstr("\"site\" beside other kinds"));
  EXPECT_THAT(problems_of(size, "size*signal", "[]"), testing::HasSubstr("\"of\" names no kind of signal"));
}

}  // namespace
}  // namespace loopwright::site_effect_test
