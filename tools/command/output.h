/// Output of the program. Messages for people go to stderr, results to stdout. Nothing here throws or ends
/// the process: a stream may be closed, its reader gone, its disk full.
#pragma once
#include <fmt/format.h>
#include <string_view>

namespace loopwright {

/// Opens something for standard descriptors that are closed. Otherwise a file opened later would get their
/// numbers and receive the output. A closed stdout stays one that accepts nothing: every result on it is
/// lost, and finish_answers() reports that. Also makes a write without a reader fail instead of killing the
/// process. Called before any file is opened.
void prepare_standard_streams();

/// To stderr, printable (see engine/json/problem.h). Lost if it cannot be written.
void tell_text(std::string_view text);
/// To stderr unchanged: control sequences of a terminal.
void tell_terminal(std::string_view text);
/// To stdout, printable.
void answer_text(std::string_view text);
/// To stdout unchanged: JSON and other data.
void answer_data(std::string_view bytes);
/// To stdout, printable: a remark on results that are in files. It may be lost if stdout was closed.
void remark_text(std::string_view text);

template <class... Values> void tell(fmt::format_string<Values...> format, Values&&... values) {
  tell_text(fmt::format(format, std::forward<Values>(values)...));
}
template <class... Values> void answer(fmt::format_string<Values...> format, Values&&... values) {
  answer_text(fmt::format(format, std::forward<Values>(values)...));
}
template <class... Values> void remark(fmt::format_string<Values...> format, Values&&... values) {
  remark_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Flushes all results. False when some of them were lost, which is then reported.
bool finish_answers();

}  // namespace loopwright
