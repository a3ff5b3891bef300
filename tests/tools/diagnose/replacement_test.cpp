// What takes the place of a member that is refused.
#include "tools/diagnose/search/replacement.h"
#include "tests/tools/diagnose/flawed_axis.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/prepare.h"

namespace loopwright::diagnosis::replacement_test {
namespace {

/// A command that comes a share of a sample late, as all of it: it has a shape and no amplitude.
Candidate late_command() {
  Candidate late;
  late.name = "late", late.acts = Acts::input, late.amplitude_is_one = true;
  late.nonlinear = {{"delay", "s", 1e-5, 1e-3, true, {}}};
  late.nonlinear[0].start = 1e-4;
  late.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> list;
    for (const std::vector<double>& shape : shapes) {
      std::vector<float> change(path.input.size());
      for (size_t k = 1; k < change.size(); ++k)
        change[k] = float(shape[0] / path.sample_time * (path.input[k - 1] - path.input[k]));
      list.push_back({Column(std::move(change))});
    }
    return list;
  };
  return late;
}

TEST(Replacement, ALateCommandTakesThePlaceOfAMemberAsAWhole) {
  const FlawedAxis axis(FlawedMachine{});
  Motion motion;
  Trials trials = prepare(axis.diagram(), {axis.experiment()}, {}, motion);
  trials.run_along(Trials::Rows::fitted);
  motion = cut(motion, trials);
  Candidate constant;
  constant.name = "constant", constant.linear = {{"level", "N", -1, 1, false, {}}};
  constant.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    return std::vector(shapes.size(), Columns{Column(std::vector<float>(path.samples(), 1.0F))});
  };
  const Candidate late = late_command();
  const Estimate with_constant = fit_members(trials, {{&constant, {0.1}, {}}}, trials.noise, motion, 2);
  ASSERT_TRUE(with_constant.is_valid);
  const Estimate other = in_place_of(trials, with_constant, 0, {{&late, 0}}, {&constant}, 2);
  EXPECT_TRUE(other.is_valid);
  for (const Member& member : other.members) EXPECT_EQ(member.candidate, &late);
}

/// A proposal is as far as linear promises go. One that is at the end of its range would have held all
/// others.
TEST(Proposal, WhatIsAtTheEndOfItsRangeStaysThereAndHoldsNothingElse) {
  Candidate constant;
  constant.name = "constant", constant.linear = {{"level", "N", -1, 1, false, {}}};
  for (const double present : {1.0, 1.2}) {
    const std::vector<Member> members =
        applied({{}, {{&constant, {0.5}, {}}}, {0.3}, 0}, {{&constant, {present}, {}}});
    ASSERT_EQ(members.size(), 2U);
    EXPECT_EQ(members[0].linear[0], 1);
    EXPECT_EQ(members[1].linear[0], 0.5);
  }
}

}  // namespace
}  // namespace loopwright::diagnosis::replacement_test
