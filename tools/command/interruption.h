/// What SIGINT and SIGTERM do. The first asks the command to end; where it does not within a moment, deep in some
/// decomposition of a large matrix, the process ends. That loses nothing: files are there whole or not at all, and a
/// sweep has on the disk what its folder holds. The second signal ends the process at once.
#pragma once
#include <atomic>

namespace loopwright {

/// Takes over both signals; called once, before anything long.
void obey_interruption();

/// Whether the user has asked the program to end.
const std::atomic<bool>& interruption();

/// From now on the command ends by itself, however long that takes: it drives hardware, or has computed what it
/// wants to write.
void take_time_after_interruption();

}  // namespace loopwright
