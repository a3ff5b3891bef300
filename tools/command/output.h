/// What the program says. Words for a person go to stderr, answers to stdout. Nothing here throws or ends the
/// process: a stream may be closed, its reader gone, its disk full.
#pragma once
#include <fmt/format.h>
#include <string_view>

namespace loopwright {

/// Opens /dev/null in the place of standard descriptors that are closed, so that no file that is opened later takes
/// their numbers and receives what is said; and has a write to nobody fail instead of killing the process.
void prepare_standard_streams();

/// To stderr, printable (see engine/json/problem.h). Lost when it cannot be written.
void tell_text(std::string_view text);
/// To stderr as it is: what moves the cursor of a terminal.
void tell_terminal(std::string_view text);
/// To stdout, printable.
void answer_text(std::string_view text);
/// To stdout as it is: JSON and other data.
void answer_data(std::string_view bytes);

template <class... Values> void tell(fmt::format_string<Values...> format, Values&&... values) {
  tell_text(fmt::format(format, std::forward<Values>(values)...));
}
template <class... Values> void answer(fmt::format_string<Values...> format, Values&&... values) {
  answer_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Brings everything that was answered to its reader; false when some of it got lost, which is then told.
bool finish_answers();

}  // namespace loopwright
