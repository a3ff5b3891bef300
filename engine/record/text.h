/// Text and numbers in recordings.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace loopwright {

/// The offset of the first byte that is not part of a valid UTF-8 character (or is NUL); npos if there is
/// none.
size_t find_not_text(std::string_view text);

/// Converts text to one line of printable UTF-8: \\ \n \r \t, and \xHH for other control characters, bytes
/// that are not UTF-8, blanks at either end, a byte order mark at the start, and every character of `also`.
std::string escape(std::string_view text, std::string_view also = {});

/// Reverses escape(); other backslashes are kept.
std::string unescape(std::string_view text);

/// The text for a message: escaped, and shortened if it is long.
std::string excerpt(std::string_view text);

/// The text without blanks and tabs at either end.
std::string_view trim(std::string_view text);

/// Appends the shortest decimal number that reads back as the same double. Integers below 1e15 are written in
/// full: 100000, not 1e+05.
void append_number(std::string& text, double value);

/// Files are written in pieces of this size [bytes]: it limits the memory, and longer ones are not faster.
inline constexpr size_t written_piece = 1 << 20;

/// UTF-16 as stored by MATLAB. A byte b that is not UTF-8 becomes the lone surrogate 0xDC00 + b and is
/// restored exactly (as in Python, PEP 383); other lone surrogates become U+FFFD.
std::u16string to_utf16(std::string_view text);
std::string from_utf16(std::u16string_view text);

}  // namespace loopwright
