#include "tools/deploy/console.h"
#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <climits>

namespace loopwright {
namespace {

/// False: nothing more is accepted. Text that was not written after this many milliseconds stays in `text`.
bool write_some(int descriptor, std::string_view& text, int milliseconds) noexcept {
  pollfd event = {descriptor, POLLOUT, 0};
  if (poll(&event, 1, milliseconds) != 1) return true;
  if (!(event.revents & POLLOUT)) return false;
  // A pipe that is ready for writing accepts this much without blocking.
  const ssize_t written = write(descriptor, text.data(), std::min<size_t>(text.size(), PIPE_BUF));
  if (written < 0) return errno == EINTR || errno == EAGAIN;
  text.remove_prefix(size_t(written));
  return true;
}

}  // namespace

bool write_text(int descriptor, std::string_view text, const std::function<bool()>& gives_up) noexcept {
  while (!text.empty()) {
    const size_t before = text.size();
    if (!write_some(descriptor, text, 100)) return false;
    if (text.size() == before && gives_up()) return false;
  }
  return true;
}

void say(std::string_view text, int patience_ms, int descriptor) noexcept {
  while (!text.empty()) {
    const size_t before = text.size();
    if (!write_some(descriptor, text, patience_ms) || text.size() == before) return;
  }
}

}  // namespace loopwright
