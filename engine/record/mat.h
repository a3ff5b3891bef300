/// Recordings as MATLAB files (MAT), through matio.
#pragma once
#include <string>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// Reads MAT files of version 4, 5 (MATLAB 5 to 7) and 7.3.
///
/// Vectors, upright or lying, become columns; a matrix becomes a column each, "name[0]", "name[1]", …; the
/// fields of a 1×1 structure become "structure.field". Integers, logicals and single precision become the
/// nearest double. Next to columns of many rows, scalars and texts become facts. In files of write_mat() the
/// names, units and facts are restored exactly; variables that were added since become columns of their own.
///
/// Errors: no MAT file, a damaged or shortened one; columns of unequal length; complex numbers, sparse
/// matrices, cells, nested structures and arrays of them, arrays of more than two dimensions; NaN and
/// infinity; no numbers at all. After any of them the recording is empty. One flipped bit
/// can make matio 1.5.23 compute for minutes and take gigabytes, and crashes were reported of it; it
/// therefore works in a process of its own with limits of time and memory.
Recording read_mat(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// Writes a MAT 5 file, compressed unless told otherwise: each column as an upright vector under its name
/// made legal in MATLAB ("stage.position" → stage_position), and beside them
///
///     loopwright_names   1×n cell of texts: the names as they were, in order
///     loopwright_units   1×n cell of texts: the SI units, '' where not known
///     loopwright_facts   m×2 cell of texts: key and value
///
/// read_mat() restores every double bit by bit. The file appears whole or not at all. Throws
/// std::runtime_error when it cannot be written or a column is beyond the 2 GiB of a MAT 5 variable,
/// std::invalid_argument when the recording is not well formed (see check_recording).
void write_mat(const std::string& path, const Recording& recording, bool compressed = true);

}  // namespace loopwright
