// 1/min can count revolutions or plain numbers: where radians are wanted it is ambiguous.
#include "engine/unit/scaled_rate.h"
#include <gtest/gtest.h>
#include "engine/unit/rescaling.h"

namespace loopwright::scaled_rate_test {
namespace {

using Kind = Conversion::Kind;

Unit unit(std::string_view text) { return parse_unit(text).value(); }
Kind kind(std::string_view from, std::string_view to) { return conversion(unit(from), unit(to)).kind; }

TEST(ScaledRate, IsAReciprocalTimeWithAScale) {
  for (const char* text : {"1/min", "1/h", "1/ms", "min^-1", "min-1", "count/min", "1/(min*s)", "1/min^2"})
    EXPECT_TRUE(is_scaled_rate(unit(text))) << text;
  for (const char* text :
       {"1/s", "rpm", "deg/s", "Hz", "kHz", "rad/min", "mm/s", "m/min", "min", "1", "%", "kN*m"})
    EXPECT_FALSE(is_scaled_rate(unit(text))) << text;
}

TEST(ScaledRate, IsAmbiguousBesideRadiansInBothDirections) {
  for (const char* rate : {"1/min", "1/h", "1/ms"}) {
    for (const char* rotation : {"rad/s", "rpm", "deg/s"}) {
      EXPECT_EQ(kind(rate, rotation), Kind::ambiguous) << rate << " " << rotation;
      EXPECT_EQ(kind(rotation, rate), Kind::ambiguous) << rate << " " << rotation;
    }
    for (const char* plain : {"1/s", "1/min", "1/us"}) EXPECT_EQ(kind(rate, plain), Kind::none) << rate;
    EXPECT_EQ(kind(rate, "Hz"), Kind::ambiguous) << rate;
  }
  EXPECT_EQ(kind("1/(min*s)", "rad/s^2"), Kind::ambiguous);
  EXPECT_EQ(kind("1/s", "rad/s"), Kind::none);
  EXPECT_EQ(kind("m/min", "m/s"), Kind::none);
}

TEST(ScaledRate, StaysRecognizableInSi) {
  EXPECT_EQ(conversion(kept_in_si(unit("1/min")), unit("rad/s")).kind, Kind::ambiguous);
  for (const char* text : {"rpm", "kHz", "mm", "degC"})
    EXPECT_EQ(kept_in_si(unit(text)), unit(text).in_si()) << text;
  for (const char* text : {"1/min", "1/h", "1/ms"}) EXPECT_EQ(to_string(unit(text)), text);
}

/// The result of a function of n in 1/min, w in rad/s and f in Hz.
std::pair<UnitFinding, Unit> found(double (*function)(double n, double w, double f, double pi)) {
  const std::vector<Quantity> arguments = {{1.0, unit("1/min")}, {2.0, unit("rad/s")}, {3.0, unit("Hz")}};
  Unit result;
  const UnitFinding finding =
      find_unit([&](const std::vector<double>& at, double pi) { return function(at[0], at[1], at[2], pi); },
                arguments, result);
  return {finding, result};
}

TEST(ScaledRate, SurvivesInMultiplesAndIsNoRadianInSums) {
  const auto twice = found([](double n, double, double, double) { return 2 * n; });
  EXPECT_TRUE(is_scaled_rate(twice.second));
  const auto radians = found([](double n, double w, double, double pi) { return w + 2 * pi * n; });
  EXPECT_EQ(radians.first, UnitFinding::known);
  EXPECT_EQ(radians.second, unit("rad/s"));
  EXPECT_EQ(found([](double n, double w, double, double) { return n + w; }).first, UnitFinding::mixed_turns);
  EXPECT_EQ(found([](double n, double, double f, double) { return n + f; }).first, UnitFinding::mixed_turns);
  const auto period = found([](double n, double, double, double) { return 1 / n; });
  EXPECT_EQ(period.second, unit("s"));
}

}  // namespace
}  // namespace loopwright::scaled_rate_test
