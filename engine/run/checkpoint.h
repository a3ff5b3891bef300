/// A run set aside in a file: the arena, the instant, the solver and the rows so far. It belongs to one plan,
/// told by its identity: the same diagram, parameters, contents of files, and program.
#pragma once
#include "engine/run/recorder.h"

namespace loopwright {

/// Written whole or not at all. `solver`: a StateArchive of what goes on beside the run. Throws
/// std::runtime_error when the file cannot be written.
void write_checkpoint(const std::string& path, Run<double>& run, const RunIdentity& identity,
                      const std::string& solver, Recorder& recorder);

/// Puts run, identity and recorder where they were; returns what was given as `solver`. Throws InputError
/// when the file is damaged, or with what has changed since.
std::string read_checkpoint(const std::string& path, Run<double>& run, RunIdentity& identity,
                            Recorder& recorder);

}  // namespace loopwright
