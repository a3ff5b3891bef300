/// Recordings from and to files of either kind.
#pragma once
#include <string>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// By the end of the path, in either case of letters: .csv (also .txt, .tsv, .dat) → read_csv, .mat →
/// read_mat; any other is an error.
Recording read_recording(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// By the end of the path: .csv → write_csv, .mat → write_mat. Throws std::runtime_error for any other,
/// before anything is written.
void write_recording(const std::string& path, const Recording& recording);

/// Whether write_recording() knows what to do, so that a program can refuse the path before it computes for
/// hours.
bool is_recording_path(const std::string& path);
/// The same of CSV alone, which can be written row by row.
bool is_csv_path(const std::string& path);

}  // namespace loopwright
