/// A run set aside in a file: the arena, the tick and the rows so far. It belongs to one plan, told by its
/// identity: the same diagram, parameters, contents of files, and program.
#pragma once
#include "engine/run/recorder.h"

namespace loopwright {

/// Written whole or not at all. Throws std::runtime_error when the file cannot be written.
void write_checkpoint(const std::string& path, Run<double>& run, const RunIdentity& identity,
                      Recorder& recorder);

/// Puts run, identity and recorder where they were. Throws InputError when the file is damaged, or with what has
/// changed since.
void read_checkpoint(const std::string& path, Run<double>& run, RunIdentity& identity, Recorder& recorder);

}  // namespace loopwright
