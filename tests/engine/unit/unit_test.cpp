#include "engine/unit/unit.h"
#include <cmath>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace loopwright::unit_test {
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
    "1",       "m",       "kg",     "s",       "A",       "K",          "mol",        "cd",      "N",
    "N*m",     "N*s/m",   "V*s/m",  "V*s^2/m", "V",       "W",          "Pa",         "ohm",     "H",
    "F",       "T",       "C",      "m/s",     "m/s^2",   "m/s^3",      "1/s",        "kg*m^2",  "N/m",
    "N/A",     "N*m*s",   "V/m",    "A/V",     "K/W",     "J/(kg*K)",   "Pa*s",       "1/m",     "1/(m*s)",
    "m^2/s",   "N^2",     "V^2",    "1/V",     "mm",      "um",         "kN",         "mV",      "%",
    "deg",     "rpm",     "km/h",   "g",       "inch",    "V/Hz^0.5",   "V/sqrt(Hz)", "m^(1/3)", "m^2.5",
    "N*s^0.5", "W/m^2",   "kg/m^3", "mol/s",   "cd/m^2",  "J",          "J*s",        "bar",     "rad",
    "rad/s",   "rad/s^2", "Hz",     "kHz",     "1/Hz",    "N*m/rad",    "N*m*s/rad",  "rev",     "rev/s",
    "deg/s",   "V/Hz",    "1/rad",  "Hz*s",    "V*s/rad", "rad/(Hz*s)", "N*m/Hz"};

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

TEST(ParseUnit, CountsPiecesAsOne) {
  for (const auto* text : {"", " ", "1", "m/m", "count", "counts", "pulses", "steps", "LSB"})
    EXPECT_EQ(unit(text), Unit{}) << text;
}

TEST(CountedUnit, IsToldByItsWords) {
  for (const char* text : {"counts", "count", "pulses/s", "LSB", "steps", "10 counts"})
    EXPECT_TRUE(is_counted(text)) << text;
  for (const char* text : {"rad", "1", "", "deg", "counter", "m/s", "discounts"})
    EXPECT_FALSE(is_counted(text)) << text;
}

TEST(ParseUnit, FollowsRadiansThatFitPlainNumbers) {
  EXPECT_TRUE(unit("rad").fits(Unit{}));
  EXPECT_TRUE(unit("rad/s").fits(unit("1/s")));
  EXPECT_TRUE(unit("N*m/rad").fits(unit("N*m")));
  EXPECT_EQ(unit("rad/s").radians(), 1);
  EXPECT_EQ(unit("rpm"), unit("rev/min"));
  EXPECT_EQ(unit("rpm").radians(), 1);
  EXPECT_EQ(unit("N*m*s/rad").radians(), -1);
  EXPECT_DOUBLE_EQ(unit("deg").scale, std::acos(-1.0) / 180);
  EXPECT_DOUBLE_EQ(unit("%").scale, 0.01);
  EXPECT_DOUBLE_EQ(unit("rev").scale, 2 * std::acos(-1.0));
}

TEST(ParseUnit, LetsHertzCountCyclesWhateverThePrefix) {
  for (const auto* text : {"Hz", "kHz", "hertz", "kilohertz", "MHz"}) {
    EXPECT_EQ(unit(text).cycles(), 1) << text;
    EXPECT_TRUE(unit(text).same_dimension(unit("1/s"))) << text;
    EXPECT_FALSE(unit(text).fits(unit("1/s"))) << text;
    EXPECT_FALSE(unit(text).fits(unit("rad/s"))) << text;
  }
  EXPECT_EQ(unit("kHz").scale, 1000);
  EXPECT_EQ(unit("Hz*s*rad/(Hz*s)"), unit("rad"));
  for (const auto* text : {"rpm", "rev/s", "cycle/s", "deg/s", "1/s", "Bq"})
    EXPECT_EQ(unit(text).cycles(), 0) << text;
}

TEST(ParseUnit, ReadsTemperaturesWithAZeroOfTheirOwn) {
  EXPECT_DOUBLE_EQ(unit("degC").to_si(20), 293.15);
  EXPECT_NEAR(unit("degF").to_si(68), 293.15, 1e-12);
  EXPECT_NEAR(unit("degF").from_si(unit("degF").to_si(68)), 68, 1e-12);
  EXPECT_TRUE(unit("degC").is_point);
  EXPECT_FALSE(unit("K").is_point);
  EXPECT_EQ(unit("degC/s"), unit("K/s"));  // a slope has no zero
  EXPECT_EQ(unit("W/degC"), unit("W/K"));
  EXPECT_EQ(to_string(unit("degC")), "degC");
  EXPECT_EQ(to_string(unit("degF")), "degF");
  EXPECT_EQ(to_string(unit("degC").in_si()), "K");
}

/// Every unit of rotation and frequency, with its value in rad/s. A plain 1/s is a rad/s.
const std::vector<std::pair<const char*, double>> rates = {{"Hz", 2 * std::acos(-1.0)},
                                                           {"kHz", 2000 * std::acos(-1.0)},
                                                           {"rpm", 2 * std::acos(-1.0) / 60},
                                                           {"rad/s", 1},
                                                           {"deg/s", std::acos(-1.0) / 180},
                                                           {"rev/s", 2 * std::acos(-1.0)},
                                                           {"1/s", 1}};

TEST(Conversion, KeepsTheRotationOrRefuses) {
  for (const auto& [from, from_rate] : rates)
    for (const auto& [to, to_rate] : rates) {
      const Conversion convert = conversion(unit(from), unit(to));
      const bool is_plain = std::string(from) == "1/s" || std::string(to) == "1/s";
      const bool has_hertz = unit(from).cycles() != unit(to).cycles();
      if (is_plain && has_hertz) {
        EXPECT_EQ(convert.kind, Conversion::Kind::ambiguous) << from << " → " << to;
        continue;
      }
      const double there = unit(to).from_si(convert(unit(from).to_si(3)));
      EXPECT_NEAR(there * to_rate / (3 * from_rate), 1, 1e-14) << from << " → " << to;
    }
  EXPECT_EQ(conversion(unit("m"), unit("Hz")).kind, Conversion::Kind::impossible);
  EXPECT_EQ(conversion(unit("N*m/Hz"), unit("N*m*s/rad")).kind, Conversion::Kind::turns);
  EXPECT_NEAR(conversion(unit("N*m/Hz"), unit("N*m*s/rad"))(2 * std::acos(-1.0)), 1, 1e-15);
}

TEST(Conversion, GivesTheSameBitsAsTheFactorWrittenOut) {
  const double pi = std::acos(-1.0);
  for (const double hertz : {40.0, 0.1, 19.8, 1e-3})
    EXPECT_EQ(conversion(unit("Hz"), unit("rad/s"))(hertz), 2 * pi * hertz);
}

TEST(ParseUnit, ReadsRoots) {
  EXPECT_EQ(unit("V/Hz^0.5"), unit("V/sqrt(Hz)"));
  EXPECT_EQ(unit("m^(1/2)").exponents[0], 0.5f);
  EXPECT_EQ(unit("sqrt(m^2)"), unit("m"));
  EXPECT_EQ(unit("(N*s)^0.5*(N*s)^0.5"), unit("N*s"));
}

TEST(ParseUnit, RefusesWhatIsNoUnit) {
  for (const auto* text : {"x",       "m @ 3",    "lg(re 1 mW)", "seconds since 2000-01-01",
                           "m^",      "sqrt(",    "sqrt(m",      "^2",
                           "m^(1/0)", "0 m",      "-1 m",        "1e400 m",
                           "m^999",   "N**",      "Nm",          "((((m",
                           "m/",      "\xff\xfe", "m\n\"",       "$command"})
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
        EXPECT_EQ(again->exponents, product.exponents) << text;
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
                                                          {"rad/s", "rad/s"},
                                                          {"V*s^2/m", "V*s^2/m"},
                                                          {"V*s/m", "V*s/m"},
                                                          {"m/s/s", "m/s^2"},
                                                          {"millimeter", "mm"},
                                                          {"kN", "kN"},
                                                          {"rad", "rad"},
                                                          {"kg*m^2", "kg*m^2"},
                                                          {"W/A^2", "ohm"},
                                                          {"V*s/A", "H"},
                                                          {"J/(kg*K)", "m^2/(s^2*K)"},
                                                          {"V/sqrt(Hz)", "V/Hz^(1/2)"},
                                                          {"kHz", "kHz"},
                                                          {"1/s", "1/s"},
                                                          {"N*m/rad", "N*m/rad"},
                                                          {"rpm", "rpm"},
                                                          {"deg/s", "deg/s"},
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
}  // namespace loopwright::unit_test
