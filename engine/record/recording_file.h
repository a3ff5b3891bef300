/// Reads and writes recordings of either file type.
#pragma once
#include <string>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// By the extension, in upper or lower case: .csv (also .txt, .tsv, .dat) → read_csv, .mat → read_mat; any
/// other is an error.
Recording read_recording(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// By the extension: .csv → write_csv, .mat → write_mat, .h5 or .hdf5 → write_hdf5. Throws std::runtime_error
/// for any other, before anything is written.
void write_recording(const std::string& path, const Recording& recording);

/// Whether a recording can be written to the path and read again, so that a program can reject it before a
/// long computation.
bool is_recording_path(const std::string& path);
/// The same for results that need not be read again: also HDF5.
bool is_result_path(const std::string& path);
/// The same for CSV only, which can be written row by row.
bool is_csv_path(const std::string& path);

}  // namespace loopwright
