/// Results of runs in append-only files. A record that has been appended survives the end of the program; one
/// that was torn or damaged is noticed, left out, and its run made again.
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
  std::vector<double> metrics;  ///< NaN where the run failed
  std::string reason;           ///< why it failed
};

struct ShardState {
  bool is_readable = false;  ///< a shard of this sweep
  std::string problem;       ///< why it is not
  int64_t records = 0;
  int64_t damaged_bytes = 0;  ///< between whole records
  int64_t torn_bytes = 0;     ///< after the last whole record: the program ended while it wrote
  int64_t whole_bytes = 0;    ///< up to the end of the last whole record
};

/// Calls `record` for each whole record, in the order of the file; needs no more memory than one.
ShardState read_shard(const std::string& path, const std::string& hash, size_t metrics,
                      const std::function<void(const RunRecord&)>& record);

/// Whether a file is a shard of this sweep, from its first line alone.
ShardState read_head_of_shard(const std::string& path, const std::string& hash, size_t metrics);

/// One writer a file: a second one is refused.
class ShardWriter {
 public:
  /// Opens or makes the file, and cuts off a torn end. Throws std::runtime_error with the reason: another
  /// writer, another sweep, no permission, full disk.
  ShardWriter(const std::string& path, const std::string& hash, size_t metrics);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// All of them or, with a std::runtime_error, none. They outlive the program when this returns, and a power
  /// cut when `flush` has returned.
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
