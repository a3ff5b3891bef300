/// Recordings as MATLAB files (MAT), through matio.
#pragma once
#include <string>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// Reads MAT files of version 4, 5 (MATLAB 5 to 7) and 7.3.
///
/// Vectors, rows or columns, become columns. A matrix gives one column for each of its columns, "name[0]",
/// "name[1]", …, or of its rows if these are as long as the other columns; an array of three dimensions,
/// whose last is time, one for each element. The fields of structures become "structure.field"; logs of
/// Simulink are unfolded (see mat_logs.h). Integers, logicals and single precision are converted to the
/// nearest double. If there are columns with many rows, scalars and texts become facts. For files of
/// write_mat() the names, units and facts are restored exactly; variables added later become further columns.
///
/// Errors: no MAT file, or a damaged or truncated one; columns of unequal length; a square matrix, whose rows
/// and columns could both be signals; complex numbers, sparse matrices, cells, objects, arrays of more than
/// three dimensions; NaN and infinity; no numbers at all. After any of them the recording is empty. One
/// flipped bit can make matio 1.5.23 compute for minutes and use gigabytes, and crashes have been reported.
/// matio therefore runs in a separate process with limits of time and memory.
Recording read_mat(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// Writes a MAT 5 file, compressed by default. Each column is a column vector whose name is made legal in
/// MATLAB ("stage.position" → stage_position). The file also has:
///
///     loopwright_names   1×n cell of texts: the names as they were, in order
///     loopwright_units   1×n cell of texts: the SI units, '' where not known
///     loopwright_facts   m×2 cell of texts: key and value
///
/// read_mat() restores every double bit by bit. The file appears completely or not at all. Throws
/// std::runtime_error if it cannot be written or a column exceeds the 2 GiB of a MAT 5 variable,
/// std::invalid_argument if the recording is not valid (see check_recording).
void write_mat(const std::string& path, const Recording& recording, bool compressed = true);

}  // namespace loopwright
