/// Checkpoint of a run in a file: the arena, the instant, the solver and the rows so far. It belongs to one
/// plan, determined by its identity: the same diagram, parameters, contents of files, and program.
#pragma once
#include "engine/run/recorder.h"

namespace loopwright {

/// Written completely or not at all. `solver`: a StateArchive of the state outside the run, such as the
/// solver. Throws std::runtime_error if the file cannot be written.
void write_checkpoint(const std::string& path, Run<double>& run, const RunIdentity& identity,
                      const std::string& solver, Recorder& recorder);

/// Restores run, identity and recorder; returns what was passed as `solver`. Throws InputError if the file is
/// damaged, or with the changes since it was written.
std::string read_checkpoint(const std::string& path, Run<double>& run, RunIdentity& identity,
                            Recorder& recorder);

}  // namespace loopwright
