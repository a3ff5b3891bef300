/// Handling of SIGINT and SIGTERM. The first signal requests the command to end. If the command does not end
/// within a moment, for example inside a decomposition of a large matrix, the process ends. No data is lost:
/// files are written completely or not at all, and a sweep has its finished runs on the disk. The second
/// signal ends the process at once.
#pragma once
#include <atomic>

namespace loopwright {

/// Installs the handlers of both signals; called once, before any long work.
void obey_interruption();

/// Whether the user has requested the program to end.
const std::atomic<bool>& interruption();

/// From now on the command ends by itself, however long that takes: it controls hardware, or has computed the
/// results that it will write.
void take_time_after_interruption();

}  // namespace loopwright
