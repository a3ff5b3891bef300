/// The variables of a MAT file as plain values, read in a process in which a crash of matio is harmless.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright::mat {

struct Variable {
  enum class Kind { numbers, text, texts, other };
  std::string name;  ///< fields of a structure: "structure.field"
  std::string unit;  ///< where a log states it
  Kind kind = Kind::other;
  size_t rows = 0, columns = 0;     ///< of the numbers or texts
  bool is_logical = false;          ///< the numbers are 0 (false) or 1 (true)
  bool is_log_of_matrices = false;  ///< of three dimensions, the last of them time: a column is an instant
  std::vector<double> numbers;      ///< column by column
  std::vector<std::string>
      texts;  ///< a text: one; a cell of texts: column by column; other: the reason why it cannot be used
};

/// Why a variable cannot be used that is an instance of a class.
inline constexpr const char* object = "an object, such as a timeseries or a Dataset";

struct Variables {
  std::vector<Variable> list;
  size_t count = 0;     ///< variables in the file; a structure counts as one
  std::string failure;  ///< reason why nothing could be read; empty: success
  std::string hint;     ///< what may be done about it
};

/// Starts a child process that reads the bytes of a file with matio and returns the result. The child is
/// terminated if it exceeds options.time_limit or options.memory_limit, or if matio crashes; this process
/// only receives the failure.
/// HDF5 requires a file with a path: version 7.3 is read from `hdf5_path`, which is empty for the other
/// versions.
Variables read_variables(std::string_view file, const std::string& hdf5_path, const ReadOptions& options);

/// All variables of a file of any version, whose bytes were read from the path that is its name. A failure
/// also if the bytes are no MAT file, or a damaged or incomplete one.
Variables read_all_variables(const SourceFile& file, const ReadOptions& options);

}  // namespace loopwright::mat
