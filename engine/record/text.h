/// Text and numbers as they stand in recordings.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace loopwright {

/// The offset of the first byte that belongs to no valid UTF-8 character (or is NUL); npos when there is
/// none.
size_t find_not_text(std::string_view text);

/// On one line of printable UTF-8: \\ \n \r \t, and \xHH for other control characters, bytes that are not
/// UTF-8, blanks at either end, a byte order mark at the start, and every character of `also`.
std::string escape(std::string_view text, std::string_view also = {});

/// Turns back what escape() did; other backslashes stay as they are.
std::string unescape(std::string_view text);

/// The text in a message: escaped, and shortened when it is long.
std::string excerpt(std::string_view text);

/// Without blanks and tabs at either end.
std::string_view trim(std::string_view text);

/// Appends the shortest decimal number that reads back as the same double; whole numbers below 1e15 are
/// written out, 100000 rather than 1e+05.
void append_number(std::string& text, double value);

/// UTF-16 as MATLAB keeps its text. A byte b that is not UTF-8 becomes the lone surrogate 0xDC00 + b and
/// comes back as it was (as in Python, PEP 383); other lone surrogates become U+FFFD.
std::u16string to_utf16(std::string_view text);
std::string from_utf16(std::u16string_view text);

}  // namespace loopwright
