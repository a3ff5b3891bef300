#include "engine/record/text.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace loopwright {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// One character of UTF-8: its code point and length in bytes; length 0 when the bytes are no valid
/// character.
struct Character {
  char32_t code = 0;
  size_t length = 0;
};

/// Source: Unicode 15, table 3-7 (no overlong forms, no surrogates, nothing above U+10FFFF).
Character first_character(std::string_view text) {
  const auto byte = [text](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
  char32_t code = lead & (0xFF >> (length + 1));
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (overlong || surrogate || code > 0x10FFFF) return {};
  return {code, length};
}

void append_utf8(std::string& text, char32_t code) {
  const auto put = [&text](char32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      put(0xE0 | code >> 12);
    } else {
      put(0xF0 | code >> 18);
      put(0x80 | (code >> 12 & 0x3F));
    }
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

int hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

size_t find_not_text(std::string_view text) {
  size_t at = 0;
  while (at < text.size()) {
    // Recordings are almost entirely ASCII: check eight bytes at a time for high bits and zero bytes.
    uint64_t eight;
    while (at + sizeof eight <= text.size()) {
      std::memcpy(&eight, text.data() + at, sizeof eight);
      constexpr uint64_t high_bits = 0x8080808080808080u, ones = 0x0101010101010101u;
      if ((eight | (eight - ones)) & high_bits) break;
      at += sizeof eight;
    }
    if (at == text.size()) break;
    const Character character = first_character(text.substr(at));
    if (character.length == 0 || character.code == 0) return at;
    at += character.length;
  }
  return std::string_view::npos;
}

std::string escape(std::string_view text, std::string_view also) {
  std::string result;
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    const size_t length = first_character(text.substr(at)).length;
    const bool at_an_end = at == 0 || at + 1 == text.size();
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    const bool leading_mark = at == 0 && text.starts_with(byte_order_mark);
    if (c == '\\') {
      result += "\\\\";
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\r') {
      result += "\\r";
    } else if (c == '\t') {
      result += "\\t";
    } else if (length == 0 || control || leading_mark || (c == ' ' && at_an_end) ||
               also.find(c) != also.npos) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      result += text.substr(at, length);
      at += length;
      continue;
    }
    ++at;
  }
  return result;
}

std::string unescape(std::string_view text) {
  std::string result;
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const char next = at + 1 < text.size() ? text[at + 1] : '\0';
    const size_t simple = std::string_view("\\nrt").find(next);
    if (c == '\\' && next != '\0' && simple != std::string_view::npos) {
      result += "\\\n\r\t"[simple];
      ++at;
    } else if (c == '\\' && next == 'x' && at + 3 < text.size() && hexadecimal_digit(text[at + 2]) >= 0 &&
               hexadecimal_digit(text[at + 3]) >= 0) {
      result += static_cast<char>(hexadecimal_digit(text[at + 2]) * 16 + hexadecimal_digit(text[at + 3]));
      at += 3;
    } else {
      result += c;
    }
  }
  return result;
}

std::string excerpt(std::string_view text) {
  constexpr size_t longest = 60;
  if (text.size() <= longest) return escape(text);
  size_t end = longest;
  while (end > longest - 4 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return escape(text.substr(0, end)) + fmt::format("… ({} bytes)", text.size());
}

std::string_view trim(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return text.substr(0, 0);  // still points into the text
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

void append_number(std::string& text, double value) {
  char digits[32];                        // the longest is 24 characters: -2.2250738585072014e-308
  constexpr double longest_count = 1e15;  // larger counts do not occur; all below are exact
  const bool is_count = std::abs(value) < longest_count && value == std::trunc(value);
  const auto [end, error] =
      is_count ? std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed)
               : std::to_chars(digits, digits + sizeof digits, value);
  (void)error;  // cannot happen: there is room
  text.append(digits, end);
}

std::u16string to_utf16(std::string_view text) {
  std::u16string result;
  while (!text.empty()) {
    Character character = first_character(text);
    if (character.length == 0) character = {0xDC00u + static_cast<unsigned char>(text[0]), 1};
    if (character.code >= 0x10000) {
      result += static_cast<char16_t>(0xD800 + ((character.code - 0x10000) >> 10));
      result += static_cast<char16_t>(0xDC00 + ((character.code - 0x10000) & 0x3FF));
    } else {
      result += static_cast<char16_t>(character.code);
    }
    text.remove_prefix(character.length);
  }
  return result;
}

std::string from_utf16(std::u16string_view text) {
  const auto is_high = [](char16_t unit) { return unit >= 0xD800 && unit < 0xDC00; };
  const auto is_low = [](char16_t unit) { return unit >= 0xDC00 && unit < 0xE000; };
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    char32_t code = text[i];
    if (is_high(text[i]) && i + 1 < text.size() && is_low(text[i + 1])) {
      code = 0x10000 + ((code - 0xD800) << 10) + (text[++i] - 0xDC00u);
    } else if (text[i] >= 0xDC80 && text[i] < 0xDD00) {
      result += static_cast<char>(text[i] - 0xDC00);
      continue;
    } else if (is_high(text[i]) || is_low(text[i])) {
      code = 0xFFFD;
    }
    append_utf8(result, code);
  }
  return result;
}

}  // namespace loopwright
