// The bars of the study, with one run for each number.
#include "tools/studies/linear_motor/study.h"
#include <gtest/gtest.h>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include "where.h"

namespace loopwright::paper::study_test {
namespace {

const std::string diagrams = LOOPWRIGHT_SOURCE "/diagrams/linear_motor";

std::string fresh_folder() {
  const std::string folder = testing::TempDir() + "/loopwright_study";
  std::filesystem::create_directories(folder);
  return folder;
}

/// The models that are stored beside the diagrams, as controllers.
std::vector<Controller> controllers() {
  const auto at = [](const char* name) { return diagrams + "/" + name + ".json"; };
  return {{"conventional", "Conventional", at("conventional"), {}},
          {"ds", "DS", at("ds"), {}},
          {"ps", "PS", at("ps"), {}},
          {"beyond", "Beyond", at("beyond"), {}}};
}

std::vector<Condition> conditions() {
  std::vector<Condition> list = harder_conditions();
  list.insert(list.begin(), {paper_condition(), held_out_condition()});
  return list;
}

/// Hyper-parameters of a model file, compared with those of a model.
void expect_same(const std::string& file, const StudyModel& model) {
  Problems problems;
  const LearnedModel kept = read_model(file, {}, problems);
  ASSERT_FALSE(problems.has_errors()) << problems.text();
  const auto expected = gp::parameters_of(model.trained->learned.model.kernel),
             found = gp::parameters_of(kept.model.kernel);
  ASSERT_EQ(found.size(), expected.size()) << file;
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-3 * expected[i]) << file;
  EXPECT_EQ(kept.sample_count, model.trained->learned.sample_count) << file;
}

TEST(Study, TrainsTheModelsBesideTheDiagramsAndPredictsAsPublished) {
  const std::string folder = fresh_folder();
  const Models models =
      train_models(diagrams, record_experiment(diagrams, Purpose::training, 0, folder), folder);
  const PredictionErrors errors = prediction_errors(diagrams, models, 1, folder);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(errors.ds[k].mean, published.table1_ds[k], 0.2 * published.table1_ds[k]) << "DS, D" << k + 1;
    EXPECT_NEAR(errors.ps[k].mean, published.table1_ps[k], 0.2 * published.table1_ps[k]) << "PS, D" << k + 1;
    EXPECT_NEAR(errors.ps[k].mean, errors.ps[0].mean, 0.03 * errors.ps[0].mean)
        << "PS does not need coverage";
  }
  EXPECT_LT(errors.ds[1].mean, 0.8 * errors.ds[0].mean) << "DS falls with coverage";
  EXPECT_LT(errors.ds[2].mean, 0.8 * errors.ds[1].mean);
  expect_same(diagrams + "/ds.model.json", models.ds[1]);
  expect_same(diagrams + "/ps.model.json", models.ps[1]);
  expect_same(diagrams + "/beyond.model.json", models.beyond);
}

TEST(Study, Table2AndWhatBeatsItKeepTheirBars) {
  const Comparison paper = compare(controllers(), {paper_condition()}, 1);
  EXPECT_NEAR(paper.at("paper", "ds").mean / paper.at("paper", "conventional").mean, 0.695, 0.05);
  EXPECT_NEAR(paper.at("paper", "ps").mean / paper.at("paper", "conventional").mean, 0.533, 0.05);

  std::vector<Controller> without_ds = controllers();
  without_ds.erase(without_ds.begin() + 1);
  std::vector<Condition> harder = harder_conditions();
  harder.insert(harder.begin(), held_out_condition());
  const Comparison c = compare(without_ds, harder, 1);
  const auto ratio = [&](const char* condition, const char* controller) {
    return c.at(condition, controller).mean / c.at(condition, "conventional").mean;
  };
  EXPECT_LE(ratio("held_out", "beyond"), 0.10);
  EXPECT_LE(ratio("payload2x", "beyond"), 0.20);
  EXPECT_LE(ratio("delay1", "beyond"), 0.20);
  EXPECT_LE(ratio("homing1mm", "beyond"), 0.35);
  for (const Tracking& row : c.rows)
    EXPECT_LT(c.at(row.condition.key, "beyond").mean, 0.5 * c.at(row.condition.key, "ps").mean)
        << row.condition.key;
}

TEST(Study, TheFollowedPhaseIsWhatBearsAHomingError) {
  std::vector<Controller> both{controllers()[3], controllers()[3]};
  both[1].key = "still", both[1].changes.set.emplace_back("phase.distance", "1e9");
  std::vector<Condition> homing;
  for (const Condition& condition : harder_conditions())
    if (condition.key.starts_with("homing")) homing.push_back(condition);
  const Comparison c = compare(both, homing, 1);
  ASSERT_EQ(c.rows.size(), 3u);
  for (const Tracking& row : c.rows)
    EXPECT_LT(row.errors[0].mean, 0.5 * row.errors[1].mean) << row.condition.key;
}

class Statements : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    runs_ = new FigureRuns(figure_runs(controllers()));
    trained_ = new std::vector<Stretch>{{0.06, 0.29}, {0.41, 0.64}};
  }
  static void TearDownTestSuite() { delete runs_, delete trained_; }
  static std::map<std::string, bool> of(const FigureRuns& runs) {
    std::map<std::string, bool> holds;
    for (const Statement& statement : check_statements(runs, *trained_))
      holds[statement.key] = statement.holds;
    return holds;
  }
  static FigureRuns* runs_;
  static std::vector<Stretch>* trained_;
};
FigureRuns* Statements::runs_ = nullptr;
std::vector<Stretch>* Statements::trained_ = nullptr;

TEST_F(Statements, OfFigures10To17Hold) {
  for (const Statement& statement : check_statements(*runs_, *trained_))
    EXPECT_TRUE(statement.holds) << statement.figure << ": " << statement.claim << ": " << statement.measured;
}

TEST_F(Statements, DoNotHoldForTheWrongRuns) {
  FigureRuns none = *runs_;  // compensation without effect
  for (Recording* run : {&none.ds, &none.ps})
    for (Column& values : run->columns)
      if (const Column* plain = none.conventional.find(values.name)) values.values = plain->values;
  auto holds = of(none);
  for (const char* key :
       {"conventional_largest", "ds_better_inside", "ps_better_outside", "ps_better_than_ds_inside",
        "observer_falls", "observer_ds_inside", "observer_ps_everywhere"})
    EXPECT_FALSE(holds.at(key)) << key;

  FigureRuns swapped = *runs_;
  std::swap(swapped.ds, swapped.ps);
  holds = of(swapped);
  for (const char* key :
       {"ds_as_conventional_outside", "ds_constant_outside", "ps_periodic_outside", "observer_ds_outside"})
    EXPECT_FALSE(holds.at(key)) << key;

  FigureRuns unloaded = *runs_;
  unloaded.ds_loaded = unloaded.ds, unloaded.ps_loaded = unloaded.ps;
  holds = of(unloaded);
  for (const char* key : {"payload_error_0", "payload_error_2", "payload_error_4", "payload_observer_grows",
                          "payload_effort_grows"})
    EXPECT_FALSE(holds.at(key)) << key;
}

/// A study with made-up numbers.
Study small_study() {
  Study study;
  study.runs = 1;
  study.comparison.controllers = controllers();
  for (const Condition& condition : conditions())
    study.comparison.rows.push_back({condition, {{42e-6, 0}, {29e-6, 0}, {22e-6, 0}, {3e-6, 1e-7}}});
  study.statements = {{"stable", "Fig. 14", "stays stable", "it did", true}};
  return study;
}

TEST(StudyNumbers, StandUnderStableKeysInMicrometres) {
  const auto json = nlohmann::json::parse(to_json(small_study()));
  EXPECT_EQ(json.at("table1").at("ds").size(), 3u);
  EXPECT_NEAR(json.at("table2").at("beyond").get<double>(), 3, 1e-9);
  for (const char* key : {"held_out", "payload2x", "delay1", "homing1mm"}) {
    EXPECT_NEAR(json.at(key).at("conventional").get<double>(), 42, 1e-9) << key;
    EXPECT_NEAR(json.at(key).at("deviation").at("beyond").get<double>(), 0.1, 1e-9) << key;
  }
  EXPECT_TRUE(json.at("statements").at("stable").at("holds").get<bool>());
}

TEST(StudyNumbers, AnUnknownKeyIsAnErrorOfTheProgram) {
  EXPECT_THROW(small_study().comparison.at("paper", "dss"), std::out_of_range);
}

}  // namespace
}  // namespace loopwright::paper::study_test
