/// Standard streams beside a machine that moves: whoever reads them may be gone, full or asleep.
#pragma once
#include <functional>
#include <string_view>

namespace loopwright {

/// Puts /dev/null in the place of standard descriptors that are closed: else a file or device that is opened later takes
/// their numbers, and receives what is said. Before anything is opened.
void hold_standard_descriptors() noexcept;

/// Writes the text; where the reader is slow it asks every 0.1 s whether to give up. False: not all was
/// taken. Never throws, and never raises SIGPIPE where that is ignored.
bool write_text(int descriptor, std::string_view text, const std::function<bool()>& gives_up) noexcept;

/// The same to standard error, or to another stream, within the patience.
void say(std::string_view text, int patience_ms, int descriptor = 2) noexcept;

}  // namespace loopwright
