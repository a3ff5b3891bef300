#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "engine/record/atomic_file.h"
#include "engine/record/mat.h"
#include "engine/record/mat_layout.h"
#include "engine/record/mat_names.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

using Matvar = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

matvar_t* new_text(const std::string& text) {
  std::u16string units = to_utf16(text);
  // An empty text is 0×0 in MATLAB.
  std::array<size_t, 2> size = {units.empty() ? 0u : 1u, units.size()};
  return Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF16, 2, size.data(), units.data(), 0);
}

/// A cell of `texts`, column by column.
Matvar cell(const char* name, size_t rows, size_t columns, const std::vector<std::string>& texts) {
  std::vector<matvar_t*> cells;
  for (const std::string& text : texts) cells.push_back(new_text(text));
  std::array<size_t, 2> size = {rows, columns};
  void* const data = cells.empty() ? nullptr : cells.data();
  return {Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), data, 0), &Mat_VarFree};
}

Matvar upright_vector(const std::string& name, const std::vector<double>& values) {
  std::array<size_t, 2> size = {values.size(), 1};
  void* const data = const_cast<double*>(values.data());  // matio only reads it
  return {Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), data, MAT_F_DONT_COPY_DATA),
          &Mat_VarFree};
}

/// Writes all variables to the file at `path`; false if matio failed.
bool write_variables(const std::string& path, const Recording& recording, bool compressed) {
  // A header without a date: equal recordings give equal files.
  mat_t* const file = Mat_CreateVer(path.c_str(), "MATLAB 5.0 MAT-file, Loopwright recording", MAT_FT_MAT5);
  if (!file) return false;
  bool all = true;
  const auto put = [&](const Matvar& variable) {
    const auto compression = compressed ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE;
    all = all && variable && Mat_VarWrite(file, variable.get(), compression) == 0;
  };
  std::vector<std::string> names, units, facts;
  for (const Column& column : recording.columns) {
    names.push_back(column.name);
    units.push_back(column.unit);
  }
  for (const auto& fact : recording.facts) facts.push_back(fact.first);
  for (const auto& fact : recording.facts) facts.push_back(fact.second);
  const std::vector<std::string> variables = mat::legal_names(names);
  for (size_t i = 0; i < variables.size(); ++i)
    put(upright_vector(variables[i], recording.columns[i].values));
  put(cell(mat::names_variable, 1, names.size(), names));
  put(cell(mat::units_variable, 1, units.size(), units));
  put(cell(mat::facts_variable, recording.facts.size(), 2, facts));
  return (Mat_Close(file) == 0) && all;
}

/// A file in memory. matio does not detect a full disk, so the bytes are written to disk by AtomicFile.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("mat file", MFD_CLOEXEC)) {
    if (file_ < 0)
      throw std::runtime_error(fmt::format("no memory for a MAT file: {}", std::strerror(errno)));
  }
  ~MemoryFile() {
    if (mapped_ != MAP_FAILED) ::munmap(mapped_, size_);
    ::close(file_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", file_); }
  std::string_view bytes() {
    const off_t end = ::lseek(file_, 0, SEEK_END);
    if (end <= 0) return {};
    size_ = static_cast<size_t>(end);
    mapped_ = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file_, 0);
    return mapped_ == MAP_FAILED ? std::string_view{} : std::string_view{static_cast<char*>(mapped_), size_};
  }

 private:
  int file_;
  size_t size_ = 0;
  void* mapped_ = MAP_FAILED;
};

}  // namespace

void write_mat(const std::string& path, const Recording& recording, bool compressed) {
  check_recording(recording);
  constexpr size_t most_rows = ((size_t{1} << 31) - 1) / sizeof(double);
  if (recording.rows() > most_rows)
    throw std::runtime_error(
        fmt::format("cannot write \"{}\": {} rows are more than the 2 GiB that a variable of "
                    "a MAT 5 file can hold; write CSV",
                    path, recording.rows()));
  AtomicFile file(path);  // first, so that an unwritable folder is reported before the work is done
  MemoryFile memory;
  const bool written = write_variables(memory.path(), recording, compressed);
  const std::string_view bytes = memory.bytes();
  const auto layout = mat::outline(bytes);
  if (!written || !layout || !layout->damage.empty() || layout->variables != recording.columns.size() + 3)
    throw std::runtime_error(
        fmt::format("cannot write \"{}\": the MAT library failed (out of memory?)", path));
  file.write(bytes);
  file.commit();
}

}  // namespace loopwright
