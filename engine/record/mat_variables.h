/// The variables of a MAT file as plain values, read where a crash of matio does no harm.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/record/recording.h"

namespace loopwright::mat {

struct Variable {
  enum class Kind { numbers, text, texts, other };
  std::string name;  ///< fields of a structure: "structure.field"
  Kind kind = Kind::other;
  size_t rows = 0, columns = 0;  ///< of the numbers or texts
  std::vector<double> numbers;   ///< column by column
  std::vector<std::string>
      texts;  ///< a text: one; a cell of texts: column by column; other: why it cannot be used
};

struct Variables {
  std::vector<Variable> list;
  size_t count = 0;     ///< variables of the file, a structure being one
  std::string failure;  ///< why nothing could be read; empty: all went well
};

/// Forks a child that reads the bytes of a file with matio and hands over what it found. The child dies when
/// it exceeds options.time_limit or options.memory_limit, or when matio crashes; this process only sees the
/// failure.
/// HDF5 insists on a file with a path: version 7.3 is read from `hdf5_path`, which is empty for the other
/// versions.
Variables read_variables(std::string_view file, const std::string& hdf5_path, const ReadOptions& options);

}  // namespace loopwright::mat
