/// Standard streams while a machine moves: the reader may be gone, blocked or not reading.
#pragma once
#include <functional>
#include <string_view>

namespace loopwright {

/// Opens /dev/null for standard descriptors that are closed. Otherwise a file or device opened later would
/// get their numbers and receive the output. Called before anything is opened.
void hold_standard_descriptors() noexcept;

/// Writes the text. While the reader is slow, it asks every 0.1 s whether to give up. False: not everything
/// was written. Never throws, and never raises SIGPIPE if that is ignored.
bool write_text(int descriptor, std::string_view text, const std::function<bool()>& gives_up) noexcept;

/// The same to standard error or another stream, for at most this time.
void say(std::string_view text, int patience_ms, int descriptor = 2) noexcept;

}  // namespace loopwright
