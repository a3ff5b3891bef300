#include "tools/report/typography.h"
#include <gtest/gtest.h>
#include <cmath>
#include <vector>

namespace loopwright::report::typography_test {
namespace {

TEST(ReadableUnit, WritesPowersDotsAndSymbols) {
  const std::pair<std::string_view, std::string_view> cases[] = {{"", ""},
                                                                 {"1", ""},
                                                                 {"m", "m"},
                                                                 {"m/s^2", "m/s²"},
                                                                 {"V*s^2/m", "V·s²/m"},
                                                                 {"s^-1", "s⁻¹"},
                                                                 {"m**2", "m²"},
                                                                 {"um", "µm"},
                                                                 {"ohm", "Ω"},
                                                                 {"deg/s", "°/s"},
                                                                 {"V/Hz^0.5", "V/Hz^0.5"},
                                                                 {"m^", "m^"},
                                                                 {"1/s", "1/s"},
                                                                 {"N*m/rad", "N·m/rad"},
                                                                 {"unit", "unit"}};
  for (const auto& [plain, readable] : cases) EXPECT_EQ(readable_unit(plain), readable) << plain;
}

TEST(IsNumeric, TellsNumbersFromText) {
  for (const std::string_view cell :
       {"12", "-3.4e-5", "+.5", "12 µm", "98.2 %", "98.2%", "±0.3", "1.2 ± 0.1", "nan", "-inf", "3 m/s²"})
    EXPECT_TRUE(is_numeric(cell)) << cell;
  for (const std::string_view cell :
       {"", "mass", "-", ".", "12 of 13 runs", "0.1 … 0.2", "3rd", "1.2.3", "e5"})
    EXPECT_FALSE(is_numeric(cell)) << cell;
}

TEST(Grouped, SetsThousandsApart) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(2601), "2601");
  EXPECT_EQ(grouped(60'000), "60\u202F000");
  EXPECT_EQ(grouped(600'001), "600\u202F001");
  EXPECT_EQ(grouped(12'345'678), "12\u202F345\u202F678");
}

TEST(JsonString, IsHarmlessInAScript) {
  EXPECT_EQ(json_string("a\"b\\c\n</script>"), R"("a\"b\\c\u000a\u003c/script>")");
}

TEST(EscapeHtml, EscapesWhatHasAMeaning) {
  EXPECT_EQ(escape_html("<a b='\"&\">"), "&lt;a b=&#39;&quot;&amp;&quot;&gt;");
}

TEST(SignificantDigits, GrowWithTheOffset) {
  EXPECT_EQ(significant_digits(std::vector<double>{0, 1}), 7);
  EXPECT_EQ(significant_digits(std::vector<double>{1000, 1001, NAN}), 11);
  EXPECT_EQ(significant_digits(std::vector<double>{5, 5}), 7);
  EXPECT_EQ(significant_digits(std::vector<double>{}), 7);
  EXPECT_EQ(significant_digits(std::vector<double>{1, 1 + 1e-15}), 17);
}

TEST(TextWidth, CountsCharacters) { EXPECT_EQ(text_width("µm → ²"), 6u); }

TEST(Typography, ThePrefixIsThatOfTheRoundedNumber) {
  const auto text = [](double value, std::string_view unit, int digits) {
    return shown(value, unit, digits);
  };
  EXPECT_EQ(text(0.9998, "m", 3), "1 m");
  EXPECT_EQ(text(0.9997, "s", 3), "1 s");
  EXPECT_EQ(text(-999.96, "N", 4), "-1 kN");
  EXPECT_EQ(text(0.9994, "m", 3), "999 mm");
  EXPECT_EQ(text(999.4, "um", 3), "999 µm") << "no prefix before a prefix";
  EXPECT_EQ(text(1e-6, "m", 4), "1 µm");
  EXPECT_EQ(text(1e3, "V", 4), "1 kV");
  EXPECT_EQ(text(1.789e-6, "m", 4), "1.789 µm");
}

}  // namespace
}  // namespace loopwright::report::typography_test
