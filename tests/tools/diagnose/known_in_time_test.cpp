// What the diagram itself says about the time: a force that it states, and nothing else, is there.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::known_in_time_test {
namespace {

constexpr double hum = 0.5, hz = 0.4;

/// The diagram has the hum among the forces that resist.
HiddenMachine with_hum() {
  HiddenMachine machine;
  machine.mass = 0.8, machine.damping = 4, machine.force_noise = 0.02, machine.encoder_noise = 1e-6;
  machine.damping_port = "resisting.sum";
  machine.further_blocks = fmt::format(
      R"("hum": {{"type": "Sine", "amplitude": {{"value": {}, "unit": "N"}}, "frequency": {}}},
         "resisting": {{"type": "Sum", "signs": "++", "in": {{"terms": ["viscous.force", "hum.y"]}}}},)",
      hum, hz);
  return machine;
}

Diagnosis of(double coulomb) {
  HiddenAxis axis(with_hum());
  Physics truth = axis.nominal();
  truth.hum_n = hum, truth.hum_hz = hz, truth.coulomb_n = coulomb;
  return diagnose(axis.diagram(), {axis.record("hum", truth, there_and_back(0.2, 0.4))});
}

TEST(KnownInTime, NothingIsMissingWhereTheDiagramHasIt) {
  const Diagnosis d = of(0);
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
  EXPECT_LT(d.error_before, 1.3 * d.noise_floor) << to_text(d);
}

TEST(KnownInTime, FrictionBesideItIsFound) {
  const Diagnosis d = of(0.6);
  EXPECT_THAT(names(d), testing::ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  EXPECT_LT(d.error_after, 1.3 * d.noise_floor) << to_text(d);
}

}  // namespace
}  // namespace loopwright::known_in_time_test
