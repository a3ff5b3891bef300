// An improved diagram is written only if it can be run along the record.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/verdict/trial_run.h"
#include "tools/experiment/experiment.h"

namespace loopwright::trial_run_test {
namespace {

using testing::HasSubstr;

class TrialRun : public testing::Test {
 protected:
  /// Why the diagram is not written with the first text replaced by the second.
  std::optional<std::string> why_not_with(const std::string& text, const std::string& other) {
    const auto nominal = std::make_shared<SourceFile>(SourceFile{files.diagram(), plant.diagram});
    std::string changed = plant.diagram;
    changed.replace(changed.find(text), text.size(), other);
    Improvement improved;
    improved.file = std::make_shared<SourceFile>(SourceFile{files.diagram(), changed});
    Problems problems;
    const auto experiment = load_experiment(files.experiment(), problems);
    Diagnosis result;
    const bool usable = diagnosis::is_usable(improved, nominal, {experiment}, {}, result);
    EXPECT_EQ(result.findings.size(), usable ? 0u : 1u);
    const auto why = diagnosis::why_not_run(improved, nominal, {experiment}, {});
    EXPECT_EQ(why.has_value(), !result.findings.empty());
    return why;
  }

  Plant plant = oscillator({}, 4);
  RecordedPlant files{plant};
};

TEST_F(TrialRun, PassesAnotherParameter) {
  EXPECT_EQ(why_not_with(R"("value": 200,)", R"("value": 210,)"), std::nullopt);
}
TEST_F(TrialRun, RefusesWhatDiverges) {
  const auto why = why_not_with(R"("signs": "+--")", R"("signs": "++-")");
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("it misses mass.position by"));
}
/// A plant that only its controller holds runs away in a simulation by itself, with any law.
TEST_F(TrialRun, AsksNothingOfAPlantThatRunsAway) {
  const std::string held = R"("signs": "+--")", runs_away = R"("signs": "++-")";
  plant.diagram.replace(plant.diagram.find(held), held.size(), runs_away);
  EXPECT_EQ(why_not_with(R"("value": 200,)", R"("value": 400,)"), std::nullopt);
}
TEST_F(TrialRun, RefusesWhatCannotBeRun) {
  const auto why = why_not_with(R"("value": 1.5,)", R"("value": -1.5,)");
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("out of range"));
}

}  // namespace
}  // namespace loopwright::trial_run_test
