/// Results of runs in append-only files. A record that has been appended survives the end of the program. A
/// truncated or damaged record is detected and ignored, and its run is repeated.
///
///     loopwright sweep shard 1 <hash of the sweep> <number of metrics>\n
///     "LwR1" | length of the rest (4 bytes) | FNV-1a of the rest (8) | run (8) | failed (8) | stopped at (8)
///     | a double each metric | reason
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace loopwright {

struct RunRecord {
  int64_t run = 0;
  bool failed = false;
  double stopped_at = 0;        ///< [s] of simulated time
  std::vector<double> metrics;  ///< NaN if the run failed
  std::string reason;           ///< why it failed
};

struct ShardState {
  bool is_readable = false;  ///< a shard of this sweep
  std::string problem;       ///< why it is not one
  int64_t records = 0;
  int64_t damaged_bytes = 0;  ///< between complete records
  int64_t torn_bytes = 0;     ///< after the last complete record: the program ended while writing
  int64_t whole_bytes = 0;    ///< up to the end of the last complete record
};

/// Calls `record` for each complete record, in the order of the file; keeps at most one in memory.
ShardState read_shard(const std::string& path, const std::string& hash, size_t metrics,
                      const std::function<void(const RunRecord&)>& record);

/// Whether a file is a shard of this sweep, from its first line alone.
ShardState read_head_of_shard(const std::string& path, const std::string& hash, size_t metrics);

/// One writer per file: a second one is rejected.
class ShardWriter {
 public:
  /// Opens or creates the file, and cuts off a truncated end. Throws std::runtime_error with the reason:
  /// another writer, another sweep, no permission, full disk.
  ShardWriter(const std::string& path, const std::string& hash, size_t metrics);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Appends all of them or, with a std::runtime_error, none. They survive the end of the program when this
  /// returns, and a power failure when `flush` has returned.
  void append(std::span<const RunRecord> records);
  void flush();

 private:
  [[noreturn]] void fail(const char* what, int error) const;
  void write_all(const std::string& bytes);

  std::string path_;
  int file_ = -1;
  int64_t end_ = 0;
};

}  // namespace loopwright
