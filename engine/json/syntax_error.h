/// Explanations of JSON syntax errors.
#pragma once
#include <cstddef>
#include <memory>
#include "engine/json/problem.h"

namespace loopwright {

/// What the parser expected when it could not continue.
enum class Awaited { value, first_name, colon, comma_in_object, first_item, comma_in_list, end_of_text };

struct SyntaxErrorSite {
  Awaited awaited = Awaited::value;
  size_t cursor = 0;                             ///< just after the last valid token
  size_t innermost_bracket = std::string::npos;  ///< the one still open; npos: none
  std::string pointer;                           ///< of the present value
};

/// The mistake after the cursor, found by examining the text again.
Problem explain_syntax_error(const std::shared_ptr<const SourceFile>& file, const SyntaxErrorSite& site);

/// The first character at or after `at` that is not JSON white space.
size_t skip_space(std::string_view text, size_t at);

/// The end of the JSON text token whose opening quote is at `at`; npos if it is not closed on its line.
size_t end_of_quoted(std::string_view text, size_t at);

/// The end of the longest JSON number that starts at `at`; `at` itself if there is none.
size_t end_of_number(std::string_view text, size_t at);

/// The first byte that is not part of a UTF-8 character or that JSON does not allow (a control character);
/// npos: none.
size_t find_bad_byte(std::string_view text);

}  // namespace loopwright
