#include "engine/record/text.h"

#include <gtest/gtest.h>

#include <random>

namespace loopwright::text_test {
namespace {

TEST(Text, EscapesAreOneLineOfPlainUtf8AndComeBack) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 5000; ++i) {
    std::string text;
    for (size_t length = random() % 12; length > 0; --length) text += static_cast<char>(random());
    const std::string escaped = escape(text, ":");
    EXPECT_EQ(find_not_text(escaped), std::string::npos);
    EXPECT_EQ(escaped.find_first_of("\n\r\t:"), std::string::npos);
    EXPECT_EQ(trim(escaped), escaped);
    EXPECT_EQ(unescape(escaped), text);
    EXPECT_EQ(from_utf16(to_utf16(text)), text);
  }
}

TEST(Text, FindsWhatIsNoUtf8) {
  EXPECT_EQ(find_not_text("Größe µ 力 🙂 and more"), std::string::npos);
  EXPECT_EQ(find_not_text("12345678\xC0\x80"), 8u) << "overlong";
  EXPECT_EQ(find_not_text("\xED\xA0\x80"), 0u) << "surrogate";
  EXPECT_EQ(find_not_text("\xF4\x90\x80\x80"), 0u) << "beyond U+10FFFF";
  EXPECT_EQ(find_not_text("1234\xE5\x8A"), 4u) << "cut off";
  for (size_t place = 0; place < 40; ++place) {
    std::string text(40, 'a');
    text[place] = '\0';
    EXPECT_EQ(find_not_text(text), place);
  }
}

}  // namespace
}  // namespace loopwright::text_test
