/// Runs with a name: DIR/.loopwright/runs has the facts of each and its signals, also after a restart.
#pragma once
#include "tools/studio/session/folder.h"
#include "tools/studio/session/results.h"

namespace loopwright::studio {

/// Writes a run, and returns its name in the folder of runs. `kept_as`: that of an earlier time; empty: a new
/// one.
std::string keep_run(const Folder& folder, const StoredRun& run, const std::string& kept_as);
void remove_kept_run(const Folder& folder, const std::string& kept_as);

/// The kept runs, oldest first, without their signals. Files that are no runs are left out.
std::vector<std::shared_ptr<StoredRun>> kept_runs(const Folder& folder);
/// The signals of a kept run. Throws InputError.
std::shared_ptr<const Signals> signals_of_kept_run(const Folder& folder, const std::string& kept_as);

}  // namespace loopwright::studio
