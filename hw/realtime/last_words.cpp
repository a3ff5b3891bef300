#include "hw/realtime/last_words.h"
#include <fmt/format.h>
#include "engine/record/journal.h"

namespace loopwright::hw {
namespace {

constexpr std::array<const char*, 4> ends = {
    "the device took the safe values and is closed",
    "the device's watchdog put out its safe values; the device is closed",
    "safe values were sent, but it is not known whether the device took them",
    "nothing was sent to the device"};

}  // namespace

LastWords::LastWords(const std::string& journal, bool has_watchdog)
    : journal_(journal), has_watchdog_(has_watchdog) {
  for (size_t i = 0; i < ends.size(); ++i)
    with_log_[i] = fmt::format("{}; the log: loopwright recover {} -o FILE.csv", ends[i], journal);
}

const char* LastWords::of(OutputsSafe safe) const noexcept {
  const bool has_log = !journal_.empty() && is_journal(journal_.c_str());
  return has_log ? with_log_[size_t(safe)].c_str() : ends[size_t(safe)];
}

const char* LastWords::before_anything_is_sent() noexcept {
  return "the stop did not come to its end; nothing was sent to the device";
}
const char* LastWords::before_sampling() noexcept {
  return "the stop did not come to its end; no command was sent, and the device's watchdog is not armed";
}
const char* LastWords::while_sampling() const noexcept {
  return has_watchdog_
             ? "the stop did not come to its end; only the device's watchdog can put out its safe values"
             : "the stop did not come to its end; the outputs are not known, and there is no watchdog";
}
const char* LastWords::after_the_stop() noexcept {
  return "the stop did not come to its end; safe values had been sent before";
}

}  // namespace loopwright::hw
