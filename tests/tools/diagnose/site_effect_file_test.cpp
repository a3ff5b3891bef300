// Shapes of a user's own effect files, in a diagnosis without roles.
#include <gmock/gmock.h>
#include <cmath>
#include <fstream>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plants.h"
#include "tools/compare/compare.h"
#include "tools/diagnose/search/own_shapes.h"

namespace loopwright::site_effect_file_test {
namespace {

using testing::ElementsAre;

constexpr const char* weir = R"({
  "loopwright": 1, "effect": "weir", "title": "Flow over a weir", "physics": "Water above the crest runs off.",
  "site": "flow", "of": "level",
  "parameters": {
    "width": {"unit": "$site/$signal^1.5", "linear": true},
    "crest": {"unit": "$signal", "range": ["=lowest_signal", "=highest_signal"], "points": 8}
  },
  "formula": "width*max(0, signal - crest)^1.5"
})";

Plant tanks_with_weir() {
  Tanks m;
  m.lost = [](double level, double) { return 0.08 * std::pow(std::max(0.0, level - 0.35), 1.5); };
  return tanks(m, 3);
}

TEST(SiteEffectFile, AWeirIsNamedOnceItsFileIsThere) {
  const RecordedPlant files(tanks_with_weir());
  DiagramFolder own;
  own.with("weir.json", weir);
  DiagnoseOptions options;
  options.more_catalogues = {own.path("")}, options.improved_diagram = own.path("improved.json");
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()}, options);
  ASSERT_THAT(names(d), ElementsAre("weir")) << to_text(d);
  EXPECT_EQ(d.effects[0].site, "balance1.sum");
  EXPECT_THAT(d.effects[0].variables, ElementsAre("level1.y"));
  expect_parameter(d.effects[0], "width", -0.08, 0.02, "m^(3/2)/s");
  expect_parameter(d.effects[0], "crest", 0.35, 0.03, "m");
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  const double before = compare(files.diagram(), files.experiment(), {}).signals.front().rmse;
  EXPECT_LT(compare(d.improved, files.experiment(), {}).signals.front().rmse, 0.3 * before);
}
TEST(SiteEffectFile, InThePlaceOfTheCatalogueNoOtherShapeIsNamed) {
  IS_A_JUDGEMENT();
  const RecordedPlant files(tanks_with_weir());
  DiagramFolder own;
  own.with("steep.json",
           R"({"loopwright": 1, "effect": "steep", "title": "Steep", "physics": "A sixth power.",
  "site": "any", "of": "any", "parameters": {"size": {"unit": "$site/$signal^6", "linear": true}},
  "formula": "size*signal^6"})");
  DiagnoseOptions options;
  options.catalogues = {own.path("")};
  for (const std::string& name : names(diagnose(files.diagram(), {files.experiment()}, options)))
    EXPECT_THAT(name, testing::AnyOf("steep", "unknown"));
}
TEST(SiteEffectFile, IsOfferedWhereItsKindsOfSiteAndSignalAre) {
  DiagramFolder own;
  own.with("weir.json", weir);
  const diagnosis::ShapeCatalogue built_in({}, {}), catalogue({}, {own.path("")});
  ASSERT_EQ(catalogue.shapes().size(), built_in.shapes().size() + 1);
  const diagnosis::TermShape& shape = catalogue.shapes().back();
  using enum diagnosis::Quantity;
  EXPECT_TRUE(shape.fits(flow, position));
  EXPECT_TRUE(shape.fits(other, other)) << "a signal without a unit may be anything";
  EXPECT_FALSE(shape.fits(heat, position));
  EXPECT_FALSE(shape.fits(flow, velocity));
  double column;
  const double crest = 0.5;
  shape.evaluate(0.9, &crest, &column);
  EXPECT_NEAR(column, std::pow(0.4, 1.5), 1e-15);
}

}  // namespace
}  // namespace loopwright::site_effect_file_test
