#include "hw/realtime/loop_end_text.h"
#include <fmt/format.h>

namespace loopwright::hw {
namespace {

std::string too_late(const LoopStatistics& s, const std::string& at) {
  std::string slowest;
  for (size_t i = 0; i < std::min<size_t>(3, s.blocks.size()); ++i)
    slowest += fmt::format("{}{} {:.1f} us", i ? ", " : "", s.blocks[i].path, s.blocks[i].longest_us);
  return fmt::format(
      "{} commands in a row came too late, {}; longest read {:.0f} us, step {:.0f} us, write {:.0f} us; "
      "the slowest blocks: {}",
      s.most_overruns_in_row, at, 1e-3 * double(s.read.longest_ns()), 1e-3 * double(s.step.longest_ns()),
      1e-3 * double(s.write.longest_ns()), slowest);
}

}  // namespace

std::string policy_that_ended(LoopEnd::Why why, const LoopStatistics& s, const Policy& policy,
                              const std::string& at) {
  using Why = LoopEnd::Why;
  if (why == Why::lost)
    return fmt::format(
        "the device lost {} samples in a row {}; {} end a run (\"on_lost\", \"most_lost\" in the device "
        "file's policy)",
        s.longest_gap, at, policy.lost_that_end());
  if (why == Why::skipped)
    return fmt::format(
        "this computer left out {} periods in a row {}; {} end a run (\"most_skipped\" in the device file's "
        "policy)",
        s.longest_gap, at, policy.most_skipped);
  return why == Why::overruns ? too_late(s, at) : "";
}

}  // namespace loopwright::hw
