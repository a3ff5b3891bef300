// What is remembered is what would be computed anew, and nothing else is taken for it.
#include "tools/diagnose/search/remembered_runs.h"
#include "tests/tools/diagnose/recorded_axis.h"
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/input_chain.h"
#include "tools/diagnose/search/prepare.h"

namespace loopwright::diagnosis::remembered_runs_test {
namespace {

/// A record, and a constant and a wave along it as members.
class RememberedRunsTest : public testing::Test {
 protected:
  RememberedRunsTest() {
    Truth truth;
    truth.duration_s = 3;
    axis_.emplace(truth);
    trials_ = prepare(axis_->diagram(), {axis_->experiment()}, {}, motion_);
    trials_.run_along(Trials::Rows::fitted);
    motion_ = cut(motion_, trials_);
    constant_.linear = {{"level", "N", -1, 1, false, {}}};
    constant_.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
      const Columns ones{Column(std::vector<float>(path.samples(), 1.0f))};
      return std::vector(shapes.size(), ones);
    };
    wave_.linear = constant_.linear;
    wave_.nonlinear = {{"pitch", "m", 0.01, 0.1, true, {}}};
    wave_.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
      std::vector<Columns> list;
      for (const std::vector<double>& shape : shapes) {
        std::vector<float> sine;
        for (double x : path.position) sine.push_back(float(std::sin(x / shape[0])));
        list.push_back({Column(std::move(sine))});
      }
      return list;
    };
    members_ = {{&constant_, {0.02}, {}}, {&wave_, {0.01}, {0.03}}};
  }
  Results run() { return trials_.remembered->run(trials_, members_, motion_, trials_.noise); }

  std::optional<RecordedAxis> axis_;
  Motion motion_;
  Trials trials_;
  Candidate constant_, wave_;
  std::vector<Member> members_;
};

TEST_F(RememberedRunsTest, TheSameQuestionHasTheSameAnswerAsARunAnew) {
  const Results first = run(), again = run();
  EXPECT_EQ(first, again) << "run twice";
  const std::vector<Fitted> anew = run_members(trials_, members_, motion_, trials_.noise);
  EXPECT_EQ(again->front().white, anew.front().white);
}

TEST_F(RememberedRunsTest, AnotherSetMotionNoiseOrLengthIsAnotherQuestion) {
  const Results first = run();
  trials_.noise.step *= 1.0000001;
  const Results other_noise = run();
  EXPECT_NE(other_noise->front().white, first->front().white);
  members_[1].nonlinear[0] *= 1.0001;
  const Results other_shape = run();
  EXPECT_NE(other_shape->front().white, other_noise->front().white);
  motion_ = cut(motion_, trials_);
  EXPECT_NE(run(), other_shape) << "a path of its own, although its numbers are the same";
  trials_.list.front().input.pop_back();
  EXPECT_EQ(run()->front().white.size() + 1, other_shape->front().white.size());
}

TEST_F(RememberedRunsTest, SensitivitiesAreThoseOfTheFreeParameters) {
  const Results results = run();
  const auto all = trials_.remembered->sensitivities(trials_, members_, motion_, results);
  EXPECT_EQ(all, trials_.remembered->sensitivities(trials_, members_, motion_, results));
  const Sensitivity anew =
      sensitivity(members_, *motion_.paths[0], results->front(), trials_.list.front().input);
  EXPECT_EQ(all->front().columns, anew.columns);
  members_[1].is_part_of_turn = true;
  EXPECT_EQ(trials_.remembered->sensitivities(trials_, members_, motion_, results)->front().columns.size(),
            2u);
}

TEST_F(RememberedRunsTest, APathBehindAnEffectIsKnownByItsValues) {
  std::vector<uint64_t> identities;
  Candidate gain = constant_, behind = constant_;
  gain.acts = behind.acts = Acts::input;
  behind.stage = Attachment::Stage::magnets;
  behind.columns_at = [&](const Path& path, const std::vector<std::vector<double>>& shapes) {
    identities.push_back(path.identity);
    return constant_.columns_at(path, shapes);
  };
  const std::vector<double>& input = trials_.list.front().input;
  InputChain chain(*motion_.paths[0], input);
  const ChangedInput first = chain.through({{&gain, {0.1}, {}}, {&behind, {0.3}, {}}});
  EXPECT_DOUBLE_EQ(first.mean[5], input[5] - 0.4);
  chain.through({{&gain, {0.1}, {}}, {&behind, {0.4}, {}}});
  chain.through({{&gain, {0.2}, {}}, {&behind, {0.4}, {}}});
  ASSERT_EQ(identities.size(), 3u);
  EXPECT_EQ(identities[0], identities[1]) << "what comes after an effect changes nothing ahead of it";
  EXPECT_NE(identities[1], identities[2]);
  EXPECT_NE(identities[0], motion_.paths[0]->identity);
}

TEST(MeanOverRows, IsTheWeightedMeanOfTheRowsAboutEach) {
  const std::vector<double> values{3, -1, 4, 1, -5, 9, 2, -6, 5, 3, -5, 8};
  for (const double rows : {0.3, 1.0, 1.7})
    for (const RowsOfMean side : {RowsOfMean::about, RowsOfMean::after}) {
      const std::vector<double> means = mean_over_rows(values, rows, side);
      for (int k = 0; k < int(values.size()); ++k) {
        double sum = 0, weights = 0;
        for (int i = side == RowsOfMean::about ? -100 : 0; i <= 100; ++i) {
          if (std::abs(i) >= 5 * rows + 1) continue;
          const double weight = std::exp(-std::abs(i) / rows);
          sum += weight * values[size_t(std::clamp(k + i, 0, int(values.size()) - 1))], weights += weight;
        }
        EXPECT_NEAR(means[size_t(k)], sum / weights, 1e-12) << k << " over " << rows;
      }
    }
}

}  // namespace
}  // namespace loopwright::diagnosis::remembered_runs_test
