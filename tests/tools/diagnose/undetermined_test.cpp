// Effects that a record asks for without saying how large or how slow they are.
#include "tools/diagnose/verdict/undetermined.h"
#include <gmock/gmock.h>

namespace loopwright::diagnosis {
namespace {

using testing::HasSubstr;

constexpr double record_s = 12;

DiagnosedParameter size(double low, double high) {
  return {
      .name = "size", .unit = "N", .value = (low + high) / 2, .low = low, .high = high, .is_linear = true};
}
DiagnosedParameter time_of(bool is_open) {
  return {.name = "time_constant", .unit = "s", .value = 30, .low = 1, .high = 36, .is_open = is_open};
}
DiagnosedEffect drift(std::vector<DiagnosedParameter> parameters) {
  return {.name = "drift", .parameters = std::move(parameters)};
}

TEST(Undetermined, IsASizeThatMayBeZero) {
  EXPECT_THAT(why_not_determined(drift({size(-0.7, 0.3), time_of(false)}), record_s),
              HasSubstr("the size of drift is not determined"));
  EXPECT_EQ(why_not_determined(drift({size(0.1, 0.3), time_of(false)}), record_s), "");
}
TEST(Undetermined, IsNotOneOfTwoSizes) {  // as the preload of a spring; both may be certain together
  EXPECT_EQ(why_not_determined(drift({size(0.1, 0.3), size(-1, 1)}), record_s), "");
  EXPECT_EQ(why_not_determined(drift({size(-0.1, 0.3), size(-1, 1)}), record_s), "");
}
/// Far from position zero its phase there may be anything, and with it sine and cosine.
TEST(Undetermined, IsAWaveWhoseAmplitudeMayBeZero) {
  DiagnosedEffect wave = drift({size(-0.1, 0.2), size(-0.2, 0.1)});
  wave.wave = {size(0.09, 0.11), size(-3, 3)};
  EXPECT_EQ(why_not_determined(wave, record_s), "");
  wave.wave[0] = size(-0.01, 0.11);
  EXPECT_NE(why_not_determined(wave, record_s), "");
}
TEST(Undetermined, IsNoTimeWithinTheRecord) {  // of a lag, at the end of its range
  EXPECT_EQ(why_not_determined(drift({size(0.1, 0.3), time_of(true)}), 100), "");
}
TEST(Undetermined, IsATimeThatMayBeAsLongAsAny) {
  EXPECT_THAT(why_not_determined(drift({size(0.1, 0.3), time_of(true)}), record_s),
              HasSubstr("the time_constant of drift may be as long as any"));
}
TEST(Undetermined, IsNothingThatIsOptional) {
  DiagnosedEffect effect = drift({size(-0.7, 0.3), time_of(true)});
  effect.is_optional = true;
  EXPECT_EQ(why_not_determined(effect, record_s), "");
}
TEST(Undetermined, IsNoShapeWithoutASize) {  // a delay
  EXPECT_EQ(why_not_determined(drift({time_of(false)}), record_s), "");
}

}  // namespace
}  // namespace loopwright::diagnosis
