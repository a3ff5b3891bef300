#include "engine/json/syntax_error.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace loopwright {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string_view("_.+-$").find(c) != std::string_view::npos;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Explainer {
 public:
  Explainer(const std::shared_ptr<const SourceFile>& file, const SyntaxErrorSite& site)
      : file_(file), text_(file->text), site_(site) {}

  Problem explain() {
    const size_t at = skip_space(text_, site_.cursor);
    switch (site_.awaited) {
      case Awaited::value:
        return wrong_value(at);
      case Awaited::first_item:
        return wrong_value(at);
      case Awaited::first_name:
        return wrong_name(at);
      case Awaited::colon:
        return after_name(at);
      case Awaited::comma_in_object:
        return after_value(at, '}');
      case Awaited::comma_in_list:
        return after_value(at, ']');
      case Awaited::end_of_text:
        break;
    }
    if (is_glued(at)) return glued_word(at);
    return say(at, "there is something after the end of the value", "the end of the file", shown(at));
  }

 private:
  char peek(size_t at) const { return at < text_.size() ? text_[at] : '\0'; }

  Problem say(size_t at, std::string message, std::string expected = {}, std::string found = {},
              std::string hint = {}) const {
    Problem problem;
    problem.place = {file_, static_cast<uint32_t>(at)};
    problem.pointer = site_.pointer;
    problem.message = std::move(message);
    problem.expected = std::move(expected);
    problem.found = std::move(found);
    problem.hint = std::move(hint);
    return problem;
  }

  /// The word or the character at a position, for "found".
  std::string shown(size_t at) const {
    constexpr size_t longest = 40;
    size_t end = at;
    while (end < text_.size() && is_word(text_[end]) && end - at < longest) ++end;
    if (end == at && at < text_.size())
      for (++end; end < text_.size() && (text_[end] & 0xC0) == 0x80; ++end)
        continue;  // the rest of a UTF-8 character
    return std::string(text_.substr(at, end - at));
  }

  Problem ends_too_early() const {
    const size_t open = site_.innermost_bracket;
    if (open == std::string::npos) return say(text_.size(), "the file ends too early");
    const char closing = text_[open] == '{' ? '}' : ']';
    const int line = line_column({file_, static_cast<uint32_t>(open)}).line;
    return say(text_.size(), "the file ends too early",
               fmt::format("\"{}\" for the \"{}\" in line {}", closing, text_[open], line));
  }

  Problem wrong_text(size_t quote) const {
    for (size_t at = quote + 1; at < text_.size() && text_[at] != '"' && text_[at] != '\n'; ++at) {
      if (text_[at] == '\t') return say(at, "a tabulator stands inside a text", "\\t");
      if (text_[at] != '\\') continue;
      const std::string_view escape = text_.substr(at, 2);
      if (escape.size() < 2 || escape[1] == '\n') break;
      const bool is_code = escape[1] == 'u';
      if (is_code && !is_code_point(at)) {
        return say(at, "an escape does not name a character", "\\u and four hexadecimal digits",
                   std::string(text_.substr(at, std::min<size_t>(6, text_.find('"', at) - at))));
      }
      if (!is_code && std::string_view("\"\\/bfnrt").find(escape[1]) == std::string_view::npos) {
        return say(at, "an escape is not known", R"(\", \\, \/, \b, \f, \n, \r, \t or \u)",
                   "\\" + shown(at + 1).substr(0, 4));
      }
      at += is_code ? 5 : 1;
    }
    return say(quote, "a text has no closing quote", "a second \" in the same line");
  }

  /// Four hexadecimal digits; halves of surrogate pairs must be in the right order.
  bool is_code_point(size_t& backslash) const {
    const auto code_at = [this](size_t at) {
      if (text_.substr(at, 2) != "\\u" || at + 6 > text_.size()) return -1;
      int code = 0;
      for (const char c : text_.substr(at + 2, 4)) {
        if (!std::isxdigit(static_cast<unsigned char>(c))) return -1;
        code = code * 16 + (is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10);
      }
      return code;
    };
    const int code = code_at(backslash);
    if (code < 0 || (code >= 0xDC00 && code < 0xE000)) return false;
    if (code < 0xD800 || code > 0xDFFF) return true;
    const int low = code_at(backslash + 6);
    if (low < 0xDC00 || low > 0xDFFF) return false;
    backslash += 6;
    return true;
  }

  Problem wrong_name(size_t at) const {
    const char c = peek(at);
    if (at >= text_.size()) return ends_too_early();
    if (c == '"') return wrong_text(at);
    if (c == '/' || c == '#') return comment(at);
    if (c == ',') return say(at, "a member is missing before this comma", "\"name\": value", ",");
    if (c == ']') return say(at, "the wrong bracket closes the object", "}", "]");
    return say(at, "a member name must stand in double quotes", "\"name\": value", shown(at));
  }

  Problem comment(size_t at) const {
    return say(at, "comments are not allowed", {}, {}, "a \"description\" can say it");
  }

  Problem wrong_number(size_t at) const {
    const size_t end = std::min(text_.find_first_not_of("+-0123456789.eE", at), text_.size());
    std::string shortened = shown(at);
    if (shortened.size() < end - at) shortened += "…";
    if (end_of_number(text_, at) == end) {
      return say(at, "a number is too large", "at most 1.7976931348623157e308", shortened);
    }
    return say(at, "a number is not well formed", "digits before and after the point, as in -0.5 or 1e-3",
               shortened);
  }

  Problem wrong_value(size_t at) const {
    const char c = peek(at);
    if (at >= text_.size()) return ends_too_early();
    if (c == '"') return wrong_text(at);
    if (c == '/' || c == '#') return comment(at);
    if (c == '\'') return say(at, "a text must stand in double quotes", "\"", "'");
    if (is_digit(c) || c == '-' || c == '+' || c == '.') return wrong_number(at);
    if (std::string_view("]},:").find(c) != std::string_view::npos) {
      return say(at, "a value is missing", "a number, a text in quotes, true, false, [ or {",
                 std::string(1, c));
    }
    return say(at, "this is not a value", "a number, a text in quotes, true, false, [ or {", shown(at),
               "a text stands in double quotes");
  }

  Problem after_name(size_t at) const {
    if (at >= text_.size()) return ends_too_early();
    if (peek(at) == ':') return wrong_value(skip_space(text_, at + 1));
    return say(at, "a colon is missing after a member name", ":", shown(at));
  }

  Problem after_value(size_t at, char closing) const {
    if (at >= text_.size()) return ends_too_early();
    const char c = peek(at);
    if (c == ',') {
      const size_t next = skip_space(text_, at + 1);
      if (peek(next) == closing)
        return say(at, "there is a comma after the last entry",
                   fmt::format("\"{}\" without a comma", closing), ",");
      return closing == '}' ? wrong_name(next) : wrong_value(next);
    }
    if (is_glued(at)) return glued_word(at);
    if (c == '/' || c == '#') return comment(at);
    if (c == '}' || c == ']') {
      return say(at,
                 closing == '}' ? "the wrong bracket closes the object" : "the wrong bracket closes the list",
                 std::string(1, closing), std::string(1, c));
    }
    const std::string_view what =
        c == ':' ? "a colon stands at a wrong place" : "a comma is missing before this";
    return say(at, std::string(what), fmt::format("\",\" or \"{}\"", closing), shown(at));
  }

  /// "01" or "truely": a valid token followed directly by more characters.
  bool is_glued(size_t at) const {
    return at == site_.cursor && at > 0 && at < text_.size() && is_word(text_[at]) && is_word(text_[at - 1]);
  }
  Problem glued_word(size_t at) const {
    size_t begin = at;
    while (begin > 0 && is_word(text_[begin - 1])) --begin;
    const bool is_number = is_digit(text_[begin]) || text_[begin] == '-';
    const std::string_view message = is_number ? "a number is not well formed" : "this is not a value";
    return say(begin, std::string(message), is_number ? "a decimal number without leading zeros" : "",
               shown(begin));
  }

  const std::shared_ptr<const SourceFile>& file_;
  std::string_view text_;
  const SyntaxErrorSite& site_;
};

}  // namespace

Problem explain_syntax_error(const std::shared_ptr<const SourceFile>& file, const SyntaxErrorSite& site) {
  return Explainer(file, site).explain();
}

size_t skip_space(std::string_view text, size_t at) {
  return std::min(text.find_first_not_of(" \t\r\n", at), text.size());
}

size_t end_of_quoted(std::string_view text, size_t at) {
  for (++at; at < text.size() && text[at] != '\n'; ++at) {
    if (text[at] == '\\')
      ++at;
    else if (text[at] == '"')
      return at + 1;
  }
  return std::string_view::npos;
}

size_t end_of_number(std::string_view text, size_t at) {
  const auto peek = [text](size_t i) { return i < text.size() ? text[i] : '\0'; };
  const auto skip_digits = [&](size_t i) {
    while (is_digit(peek(i))) ++i;
    return i;
  };
  const size_t whole = at + (peek(at) == '-');
  size_t end = peek(whole) == '0' ? whole + 1 : skip_digits(whole);
  if (end == whole) return at;
  if (peek(end) == '.' && is_digit(peek(end + 1))) end = skip_digits(end + 1);
  if (peek(end) != 'e' && peek(end) != 'E') return end;
  const size_t exponent = end + 1 + (peek(end + 1) == '+' || peek(end + 1) == '-');
  return is_digit(peek(exponent)) ? skip_digits(exponent) : end;
}

size_t find_bad_byte(std::string_view text) {
  const auto byte = [text](size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
  };
  for (size_t at = 0; at < text.size();) {
    const unsigned lead = byte(at);
    if (lead < 0x80) {
      const bool is_control = lead < 0x20 && lead != '\t' && lead != '\n' && lead != '\r';
      if (is_control) return at;
      ++at;
      continue;
    }
    const size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    // Second bytes that would encode a character in more bytes than necessary, a surrogate, or a code point
    // beyond U+10FFFF.
    const unsigned low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (lead < 0xC2 || lead > 0xF4 || byte(at + 1) < low || byte(at + 1) > high) return at;
    for (size_t i = 2; i < length; ++i)
      if ((byte(at + i) & 0xC0) != 0x80) return at;
    at += length;
  }
  return std::string_view::npos;
}

}  // namespace loopwright
