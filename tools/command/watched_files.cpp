#include "tools/command/watched_files.h"
#include <sys/stat.h>
#include <chrono>
#include <thread>

namespace loopwright {

// Short enough to seem immediate, long enough to cost nothing. An editor that replaces a file by another, or
// writes it in pieces, is done after one such time.
constexpr auto between_looks = std::chrono::milliseconds(100);

WatchedFiles::State WatchedFiles::state_of(const std::string& path) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  return {s.st_mtim.tv_sec, s.st_mtim.tv_nsec, s.st_size, s.st_ino};
}

std::map<std::string, WatchedFiles::State> WatchedFiles::states() const {
  std::map<std::string, State> now;
  for (const auto& [path, state] : known_) now.emplace(path, state_of(path));
  return now;
}

void WatchedFiles::watch(const std::set<std::string>& paths) {
  std::map<std::string, State> next;
  for (const std::string& path : paths) {
    const auto before = known_.find(path);
    next.emplace(path, before == known_.end() ? state_of(path) : before->second);
  }
  known_ = std::move(next);
}

bool WatchedFiles::wait_for_change(const std::atomic<bool>& interrupt) {
  std::map<std::string, State> last = states();
  for (;;) {
    if (interrupt) return false;
    std::this_thread::sleep_for(between_looks);
    std::map<std::string, State> now = states();
    const bool is_at_rest = now == last;
    last = std::move(now);
    if (!is_at_rest || last == known_) continue;
    known_ = std::move(last);
    return true;
  }
}

}  // namespace loopwright
