#include "engine/unit/unit.h"
#include <cmath>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace loopwright {
namespace {

Unit unit(std::string_view text) {
  const auto parsed = parse_unit(text);
  if (!parsed) {
    ADD_FAILURE() << "cannot be read: " << text;
    return {};
  }
  return *parsed;
}

const std::vector<std::string> spellings = {
    "1",       "m",     "kg",     "s",       "A",      "K",        "mol",        "cd",      "N",
    "N*m",     "N*s/m", "V*s/m",  "V*s^2/m", "V",      "W",        "Pa",         "ohm",     "H",
    "F",       "T",     "C",      "m/s",     "m/s^2",  "m/s^3",    "1/s",        "kg*m^2",  "N/m",
    "N/A",     "N*m*s", "V/m",    "A/V",     "K/W",    "J/(kg*K)", "Pa*s",       "1/m",     "1/(m*s)",
    "m^2/s",   "N^2",   "V^2",    "1/V",     "mm",     "um",       "kN",         "mV",      "%",
    "deg",     "rpm",   "km/h",   "g",       "inch",   "V/Hz^0.5", "V/sqrt(Hz)", "m^(1/3)", "m^2.5",
    "N*s^0.5", "W/m^2", "kg/m^3", "mol/s",   "cd/m^2", "J",        "J*s",        "bar"};

TEST(ParseUnit, ReadsTheSpellingsOfMotionControl) {
  EXPECT_EQ(unit("N*s/m"), unit("kg/s"));
  EXPECT_EQ(unit("V*s^2/m"), unit("kg*m/(s*A)"));
  EXPECT_EQ(unit("kg*m/s2"), unit("N"));
  EXPECT_EQ(unit("N m"), unit("N·m"));
  EXPECT_EQ(unit("um"), unit("µm"));  // micro sign
  EXPECT_EQ(unit("um"), unit("μm"));  // Greek mu
  EXPECT_DOUBLE_EQ(unit("um").scale, 1e-6);
  EXPECT_DOUBLE_EQ(unit("rpm").scale, 2 * std::acos(-1.0) / 60);
}

TEST(ParseUnit, CountsRadiansAndPiecesAsOne) {
  for (const auto* text : {"", " ", "1", "rad", "m/m", "count", "counts", "pulses", "steps", "LSB"})
    EXPECT_EQ(unit(text), Unit{}) << text;
  EXPECT_EQ(unit("rad/s"), unit("1/s"));
  EXPECT_EQ(unit("N*m/rad"), unit("N*m"));
  EXPECT_DOUBLE_EQ(unit("deg").scale, std::acos(-1.0) / 180);
  EXPECT_DOUBLE_EQ(unit("%").scale, 0.01);
  EXPECT_DOUBLE_EQ(unit("rev").scale, 2 * std::acos(-1.0));
}

TEST(ParseUnit, ReadsRoots) {
  EXPECT_EQ(unit("V/Hz^0.5"), unit("V/sqrt(Hz)"));
  EXPECT_EQ(unit("m^(1/2)").exponents[0], 0.5f);
  EXPECT_EQ(unit("sqrt(m^2)"), unit("m"));
  EXPECT_EQ(unit("(N*s)^0.5*(N*s)^0.5"), unit("N*s"));
}

TEST(ParseUnit, RefusesWhatIsNoUnit) {
  for (const auto* text : {"x",       "degC",  "m @ 3",   "lg(re 1 mW)", "seconds since 2000-01-01",
                           "m^",      "sqrt(", "sqrt(m",  "^2",          "m^(1/0)",
                           "0 m",     "-1 m",  "1e400 m", "m^999",       "N**",
                           "Nm",      "((((m", "m/",      "\xff\xfe",    "m\n\"",
                           "$command"})
    EXPECT_FALSE(parse_unit(text)) << text;
  EXPECT_FALSE(parse_unit(std::string(100000, '(')));
  EXPECT_FALSE(parse_unit(std::string("m\0m", 3)));
}

TEST(UnitLaws, MultiplicationCommutesAndPowersInvert) {
  for (const auto& a : spellings) {
    EXPECT_TRUE((unit(a) * power(unit(a), -1)).same_dimension(Unit{})) << a;
    EXPECT_TRUE((power(power(unit(a), 0.5), 2)).same_dimension(unit(a))) << a;
    EXPECT_EQ(unit(a) * Unit{}, unit(a)) << a;
    for (const auto& b : spellings) EXPECT_EQ(unit(a) * unit(b), unit(b) * unit(a)) << a << " " << b;
  }
}

TEST(UnitLaws, ThirdsAddUpToWholes) {
  const Unit third = power(unit("m"), 1.0 / 3);
  EXPECT_TRUE((third * third * third).same_dimension(unit("m")));
}

TEST(UnitText, ReadsBackAsTheSameUnit) {
  for (const auto& spelling : spellings) {
    const std::string text = to_string(unit(spelling));
    const auto again = parse_unit(text);
    ASSERT_TRUE(again) << spelling << " → " << text;
    EXPECT_EQ(*again, unit(spelling)) << spelling << " → " << text;
  }
}

TEST(UnitText, ReadsBackForEveryPairAndPrefix) {
  for (const auto& a : spellings)
    for (const auto& b : spellings)
      for (const double scale : {1e-9, 1e-3, 1.0, 1e6, 0.7}) {
        Unit product = unit(a) * power(unit(b), -1);
        product.scale = scale;
        const std::string text = to_string(product);
        const auto again = parse_unit(text);
        ASSERT_TRUE(again) << text;
        EXPECT_TRUE(again->same_dimension(product)) << text;
        EXPECT_NEAR(again->scale / scale, 1, 1e-14) << text;
      }
}

TEST(UnitText, IsWhatAnEngineerWouldWrite) {
  const std::pair<const char*, const char*> expected[] = {{"kg*m/s^2", "N"},
                                                          {"J/s", "W"},
                                                          {"W/A", "V"},
                                                          {"N/m^2", "Pa"},
                                                          {"kg/s", "N*s/m"},
                                                          {"J", "N*m"},
                                                          {"rad/s", "1/s"},
                                                          {"V*s^2/m", "V*s^2/m"},
                                                          {"V*s/m", "V*s/m"},
                                                          {"m/s/s", "m/s^2"},
                                                          {"millimeter", "mm"},
                                                          {"kN", "kN"},
                                                          {"rad", "1"},
                                                          {"kg*m^2", "kg*m^2"},
                                                          {"W/A^2", "ohm"},
                                                          {"V*s/A", "H"},
                                                          {"J/(kg*K)", "m^2/(s^2*K)"},
                                                          {"V/sqrt(Hz)", "V*s^(1/2)"},
                                                          {"deg", "deg"},
                                                          {"percent", "%"}};
  for (const auto& [text, spelling] : expected) EXPECT_EQ(to_string(unit(text)), spelling) << text;
}

TEST(ParseUnit, MayBeCalledFromManyThreads) {
  std::vector<std::thread> threads;
  std::vector<int> good(8);
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&good, t] {
      for (int i = 0; i < 200; ++i) {
        const auto parsed = parse_unit(std::to_string(i + 1) + " N*s/m");
        good[t] += parsed && parsed->scale == i + 1 && to_string(Unit{1, parsed->exponents}) == "N*s/m";
      }
    });
  for (auto& thread : threads) thread.join();
  for (const int count : good) EXPECT_EQ(count, 200);
}

}  // namespace
}  // namespace loopwright
