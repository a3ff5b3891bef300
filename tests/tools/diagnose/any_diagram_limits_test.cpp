// What a diagnosis without roles refuses, and how its search is limited.
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plants.h"
#include "where.h"

namespace loopwright::any_diagram_limits_test {
namespace {

std::string refusal(const Plant& plant, const DiagnoseOptions& options = {}) {
  const RecordedPlant files(plant);
  try {
    diagnose(files.diagram(), {files.experiment()}, options);
  } catch (const InputError& error) {
    return error.problems.text();
  }
  return "";
}
Plant with_sites(const std::string& sites) {
  Tanks m;
  m.lost = [](double level, double) { return 0.02 * std::max(0.0, level - 0.5); };
  Plant plant = tanks(m, 3);
  plant.more = "\"sites\": " + sites;
  return plant;
}

TEST(AnyDiagramLimits, SitesOfTheExperimentLimitTheSearch) {
  const RecordedPlant files(with_sites(R"(["balance2.sum"])"));
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()});
  for (const DiagnosedEffect& effect : d.effects) EXPECT_EQ(effect.site, "balance2.sum");
  EXPECT_NE(d.verdict, Verdict::explained) << "the overflow is elsewhere: " << to_text(d);
  EXPECT_NE(d.verdict, Verdict::nothing_missing);
}
TEST(AnyDiagramLimits, AnUnknownSiteIsAProblemWithAHint) {
  const std::string text = refusal(with_sites(R"(["balance3.sum"])"));
  EXPECT_THAT(text, testing::HasSubstr("nothing can be missing there"));
  EXPECT_THAT(text, testing::HasSubstr("did you mean \"balance1.sum\"")) << text;
}
TEST(AnyDiagramLimits, SitesBesideRolesAreAProblem) {
  Plant plant = with_sites(R"(["balance1.sum"])");
  plant.more += R"(, "roles": {"position": "level1.y"})";
  EXPECT_THAT(refusal(plant), testing::HasSubstr("the sites of an axis follow from its roles"));
}
TEST(AnyDiagramLimits, ASampledBlockOnTheWayIsRefusedByName) {
  Plant plant = oscillator({}, 1);
  const std::string before = R"("net":     {"type": "Sum", "signs": "+--", "in": {"terms": ["shaker.y",)";
  const size_t at = plant.diagram.find(before);
  ASSERT_NE(at, std::string::npos);
  plant.diagram.replace(at, before.size(),
                        R"("computer": {"type": "UnitDelay", "sample_time": 0.01, "in": {"u": "shaker.y"}},
    "net":     {"type": "Sum", "signs": "+--", "in": {"terms": ["computer.y",)");
  const std::string text = refusal(plant);
  EXPECT_THAT(text, testing::HasSubstr("computer"));
  EXPECT_THAT(text, testing::HasSubstr("UnitDelay remembers more than states"));
}
TEST(AnyDiagramLimits, EffectFilesOfAnAxisAreRefused) {
  DiagnoseOptions options;
  options.catalogues = {LOOPWRIGHT_SOURCE "/diagrams/effects"};
  EXPECT_THAT(refusal(oscillator({}, 1), options),
              testing::HasSubstr("no effect in these folders acts at a site of a diagram"));
}
TEST(AnyDiagramLimits, AFewRowsAreRefused) {
  Plant plant = oscillator({}, 1);
  plant.rows = 150;
  EXPECT_THAT(refusal(plant), testing::HasSubstr("too few rows for a diagnosis"));
}
/// A thousand rows of the input, and one reading in twenty of them.
TEST(AnyDiagramLimits, AFewReadingsAreRefusedHoweverManyRowsThereAre) {
  Plant plant = oscillator({}, 1);
  plant.rows = 1000, plant.reads_every = {20};
  const std::string text = refusal(plant);
  EXPECT_THAT(text, testing::HasSubstr("at least 200 rows in which something was measured"));
  EXPECT_THAT(text, testing::HasSubstr("38 in "));
}
TEST(AnyDiagramLimits, ASearchThatUsesUpItsWorkSaysSoAndCallsNothingComplete) {
  const RecordedPlant files(with_sites(R"(["balance1.sum"])"));
  DiagnoseOptions options;
  options.most_work = 1;
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()}, options);
  EXPECT_TRUE(d.effects.empty()) << "parameters are fitted in any case";
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << to_text(d);
  EXPECT_THAT(to_text(d), testing::HasSubstr("the search ended at its limit"));
}
TEST(AnyDiagramLimits, TheSamplesMayLieAtAnyDistance) {
  Oscillator m;
  m.force = [](double x, double) { return 6000 * x * x * x; };
  Plant plant = oscillator(m, 7);
  plant.jitter = 0.3;
  const RecordedPlant files(plant);
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()});
  ASSERT_EQ(names(d), std::vector<std::string>{"cube"}) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
}

}  // namespace
}  // namespace loopwright::any_diagram_limits_test
