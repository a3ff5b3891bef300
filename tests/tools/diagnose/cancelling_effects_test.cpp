// Effects that undo each other, or leave next to nothing of the input, explain nothing.
#include "tools/diagnose/verdict/cancelling_effects.h"
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::cancelling_effects_test {
namespace {

using testing::HasSubstr;

Diagnosis with_forces(const std::vector<std::pair<std::string, double>>& forces, double missing) {
  Diagnosis d;
  d.steps.emplace_back().force_rmse = missing;
  for (const auto& [name, rms] : forces) {
    DiagnosedEffect& effect = d.effects.emplace_back();
    effect.name = name, effect.force_rms = rms;
  }
  return d;
}

TEST(CancellingEffects, AForceFarBeyondTheMissingOneIsTold) {
  EXPECT_THAT(diagnosis::why_effects_cancel(with_forces({{"inertia", 1.2}, {"dead_band", 0.2}}, 0.17)),
              HasSubstr("the force of inertia alone is 7.1 times the force that is missing"));
}
TEST(CancellingEffects, UsualSetsAreNot) {
  EXPECT_EQ(diagnosis::why_effects_cancel(with_forces({{"spring", 1.6}, {"hardening_spring", 1}}, 1)), "");
  EXPECT_EQ(diagnosis::why_effects_cancel(with_forces({{"inertia", 7}}, 1)), "") << "a single one";
  EXPECT_EQ(diagnosis::why_effects_cancel(with_forces({{"force_gain", 7}, {"inertia", 1}}, 1)), "")
      << "by one factor with the mass";
}

/// Without roles: a Stribeck curve of which the record sees no end is a square.
TEST(CancellingEffects, LevelsOfOneLawAreTold) {
  DiagnosedEffect effect;
  effect.name = "stribeck", effect.site_unit = "N*m", effect.force_rms = 0.07;
  const auto level = [](const char* name, double value) {
    DiagnosedParameter p;
    p.name = name, p.unit = "N*m", p.value = value;
    return p;
  };
  effect.parameters = {level("sliding_level", -1.46), level("breakaway_excess", 1.43)};
  EXPECT_THAT(diagnosis::why_levels_cancel(effect), HasSubstr("sliding_level and breakaway_excess"));
  effect.parameters = {level("sliding_level", 0.06), level("breakaway_excess", 1.43)};
  EXPECT_EQ(diagnosis::why_levels_cancel(effect), "") << "a short peak";
}

/// A strong saturation and a tenth of the mass stand for dry friction that differs between two records.
TEST(CancellingEffects, FrictionOfTwoRecordsIsNoSaturation) {
  HiddenAxis axis(HiddenMachine{});
  std::vector<std::string> records;
  for (const double level : {1.0, 1.3}) {
    Physics truth = axis.nominal();
    truth.coulomb_n = level;
    records.push_back(axis.record(fmt::format("level{}", records.size()), truth, there_and_back(0.05, 0.2)));
  }
  const Diagnosis d = diagnose(axis.diagram(), records);
  EXPECT_NE(name_of(d.verdict), "explained") << to_text(d);
}

}  // namespace
}  // namespace loopwright::cancelling_effects_test
