#include "engine/record/recording_file.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

#include "engine/record/csv.h"
#include "engine/record/hdf5.h"
#include "engine/record/mat.h"

namespace loopwright {
namespace {

/// ".csv" of "runs/stage.CSV"; empty when the file name has no dot.
std::string extension(const std::string& path) {
  const size_t dot = path.rfind('.'), slash = path.rfind('/');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return {};
  std::string text = path.substr(dot);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_hdf5(const std::string& end) { return end == ".h5" || end == ".hdf5"; }

std::string unknown_kind(const std::string& path) {
  const std::string end = extension(path);
  return end.empty() ? "a recording needs an extension that tells its kind"
                     : fmt::format("no kind of recording ends in \"{}\"", end);
}

}  // namespace

Recording read_recording(const std::string& path, Problems& problems, const ReadOptions& options) {
  const std::string end = extension(path);
  if (end == ".csv" || end == ".txt" || end == ".tsv" || end == ".dat")
    return read_csv(path, problems, options);
  if (end == ".mat") return read_mat(path, problems, options);
  const auto file = std::make_shared<SourceFile>(SourceFile{path, {}});
  Problem& problem = problems.error({file, 0}, {}, {},
                                    is_hdf5(end) ? "HDF5 files are written, not read" : unknown_kind(path));
  problem.expected = ".csv, .txt, .tsv, .dat or .mat";
  return {};
}

void write_recording(const std::string& path, const Recording& recording) {
  const std::string end = extension(path);
  if (end == ".csv") return write_csv(path, recording);
  if (end == ".mat") return write_mat(path, recording);
  if (is_hdf5(end)) return write_hdf5(path, recording);
  throw std::runtime_error(
      fmt::format("cannot write \"{}\": {}; expected .csv, .mat or .h5", path, unknown_kind(path)));
}

bool is_recording_path(const std::string& path) {
  const std::string end = extension(path);
  return end == ".csv" || end == ".mat";
}

bool is_result_path(const std::string& path) { return is_recording_path(path) || is_hdf5(extension(path)); }

bool is_csv_path(const std::string& path) { return extension(path) == ".csv"; }

}  // namespace loopwright
