/// Standard streams while a machine moves: the reader may be gone, blocked or not reading.
#pragma once
#include <functional>
#include <string_view>

namespace loopwright {

/// Writes the text. While the reader is slow, it asks every 0.1 s whether to give up. False: not everything
/// was written. Never throws, and never raises SIGPIPE if that is ignored.
bool write_text(int descriptor, std::string_view text, const std::function<bool()>& gives_up) noexcept;

/// The same to standard error or another stream, for at most this time.
void say(std::string_view text, int patience_ms, int descriptor = 2) noexcept;

}  // namespace loopwright
