#include <gtest/gtest.h>
#include "models/gp/table.h"
#include "tests/blocks/block_under_test.h"
#include "tests/blocks/learning/trained_model.h"

namespace loopwright::gpr_test {
namespace {

std::string settings(const ModelFolder& folder, const std::string& more = "") {
  return R"({"model": ")" + folder.path() + "\"" + more + "}";
}
double predicted(BlockUnderTest& block, double position, double velocity,
                 const std::string& output = "prediction") {
  block.input("position") = position;
  block.input("velocity") = velocity;
  block.evaluate();
  return block.output(output);
}

const char* block_output(std::string_view type) { return type == "Gpr" ? "prediction" : "deviation"; }

TEST(Gpr, PredictsThePosteriorMeanOfItsModel) {
  for (const gp::Kernel& kernel : {gp::additive(), gp::product()}) {
    const LearnedModel learned = trained_model(kernel);
    const ModelFolder folder(learned);
    const gp::Posterior posterior(learned.model);
    const double bound = gp::MeanTable(posterior).bound();
    BlockUnderTest by_table("Gpr", settings(folder)),
        exactly("Gpr", settings(folder, R"(, "prediction": "exact")"));
    ASSERT_FALSE(by_table.problems().has_errors()) << by_table.problems().text();
    for (double v : {0.05, 0.17, 0.5})
      for (double x = -0.2; x < 0.5; x += 0.0117) {
        const double expected = posterior.mean({x - 0.003, v});
        EXPECT_EQ(predicted(exactly, x, v), expected);
        EXPECT_NEAR(predicted(by_table, x, v), expected, bound);
      }
  }
}

TEST(Gpr, LooksAheadByItsLead) {
  const ModelFolder folder;
  BlockUnderTest now("Gpr", settings(folder)), ahead("Gpr", settings(folder, R"(, "lead": 0.0025)"));
  EXPECT_NEAR(predicted(ahead, 0.2, 0.4), predicted(now, 0.201, 0.4), 1e-12);
}

TEST(Gpr, FollowsAShiftOfTheHoming) {
  const ModelFolder folder;
  BlockUnderTest block("Gpr", settings(folder)), moved("Gpr", settings(folder, R"(, "homing_shift": 0.001)"));
  EXPECT_NEAR(predicted(moved, 0.201, 0.2), predicted(block, 0.2, 0.2), 1e-12);
}

TEST(Gpr, TakesTheNearestTrainedVelocityUnlessToldOtherwise) {
  const ModelFolder folder;
  BlockUnderTest block("Gpr", settings(folder));
  EXPECT_EQ(predicted(block, 0.2, 3), predicted(block, 0.2, 0.5));
  EXPECT_EQ(predicted(block, 0.2, -1), predicted(block, 0.2, 0.05));
}

TEST(Gpr, LeavesUntrainedVelocitiesToTheKernelWhenToldTo) {
  const LearnedModel learned = trained_model(gp::product());
  const ModelFolder folder(learned);
  BlockUnderTest block("Gpr", settings(folder, R"(, "untrained": "posterior")"));
  EXPECT_NEAR(predicted(block, 0.2, 0.7), gp::Posterior(learned.model).mean({0.197, 0.7}), 1e-6);
  EXPECT_NEAR(predicted(block, 0.2, 100), learned.model.label_mean, 1e-6);
}

TEST(Gpr, StopsTheRunAtUntrainedVelocitiesWhenToldTo) {
  const ModelFolder folder;
  BlockUnderTest block("Gpr", settings(folder, R"(, "untrained": "fault")"));
  for (double v : {0.0, 0.05, 0.5}) {
    predicted(block, 0.2, v);
    EXPECT_EQ(block.fault(), "") << v;
  }
  predicted(block, 0.2, 0.6);
  EXPECT_EQ(block.fault(), "the velocity lies outside of those the model was trained on");
}

TEST(Gpr, StopsTheRunWhereItIsAskedAtNoFiniteNumber) {
  const ModelFolder folder;
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const char* type : {"Gpr", "GprDeviation"})
    for (const char* untrained : {"hold", "posterior", "fault"})
      for (const auto& [x, v] :
           {std::pair(infinite, 0.1), {-infinite, 0.1}, {nan, 0.1}, {0.2, infinite}, {0.2, nan}}) {
        BlockUnderTest block(type, settings(folder, fmt::format(R"(, "untrained": "{}")", untrained)));
        predicted(block, x, v, block_output(type));
        EXPECT_EQ(block.fault(),
                  "the position or the velocity that a learned model is evaluated at is not finite")
            << type << " " << x << " " << v;
      }
}

TEST(Gpr, SaysWhichModelIsMissing) {
  BlockUnderTest block("Gpr", R"({"model": "nowhere.model.json"})");
  const std::string text = block.problems().text();
  EXPECT_NE(text.find("nowhere.model.json"), text.npos) << text;
  EXPECT_NE(text.find("loopwright gp train"), text.npos) << text;
}

TEST(GprDeviation, IsThatOfThePosterior) {
  const LearnedModel learned = trained_model();
  const ModelFolder folder(learned);
  const gp::Posterior posterior(learned.model);
  BlockUnderTest block("GprDeviation", settings(folder));
  for (double v : {0.05, 0.3, 2.0})
    EXPECT_NEAR(predicted(block, 0.2, v, "deviation"), std::sqrt(posterior.variance({0.197, v})), 1e-12);
}

TEST(GprDeviation, GrowsWhereNothingWasLearned) {
  const ModelFolder folder;
  BlockUnderTest block("GprDeviation", settings(folder));
  EXPECT_GT(predicted(block, 0.2, 2, "deviation"), 3 * predicted(block, 0.2, 0.2, "deviation"));
}

}  // namespace
}  // namespace loopwright::gpr_test
