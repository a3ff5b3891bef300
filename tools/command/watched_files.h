/// Files that an editor changes while a command goes on.
#pragma once
#include <atomic>
#include <map>
#include <set>
#include <string>

namespace loopwright {

class WatchedFiles {
 public:
  /// From now on these; what they are now counts as known, for those that were watched before what was known.
  void watch(const std::set<std::string>& paths);
  /// Waits until one of them has changed and is at rest. False: interrupted.
  bool wait_for_change(const std::atomic<bool>& interrupt);

 private:
  /// Of a file: time of its last change, size, number. All 0: it does not exist.
  struct State {
    long long seconds = 0, nanoseconds = 0, size = 0;
    unsigned long long number = 0;
    bool operator==(const State&) const = default;
  };
  static State state_of(const std::string& path);
  std::map<std::string, State> states() const;

  std::map<std::string, State> known_;
};

}  // namespace loopwright
