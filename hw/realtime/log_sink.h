/// Destination of the log rows after they have left the loop.
#pragma once
#include <algorithm>
#include "engine/record/journal.h"

namespace loopwright::hw {

/// Called by one thread; sync() by another. A return value other than 0 is an errno, and no more rows are
/// taken.
class LogSink {
 public:
  virtual ~LogSink() = default;
  /// Complete rows. `dropped`: number of rows dropped so far.
  virtual int take(std::span<const double> rows, int64_t dropped) = 0;
  virtual int sync() noexcept { return 0; }
  /// No more rows follow.
  virtual int end(const Facts&, int64_t /*dropped*/) { return 0; }
};

/// Writes to a growing file; see engine/record/journal.h.
class JournalSink final : public LogSink {
 public:
  JournalSink(const std::string& path, const Recording& heading) : journal_(path, heading) {}
  int take(std::span<const double> rows, int64_t dropped) override {
    // The header is repeated at intervals: a damaged beginning does not make the rest unreadable.
    if (++chunks_ % chunks_between_headings == 0)
      if (const int error = journal_.repeat_heading()) return error;
    return journal_.append(rows, dropped);
  }
  int sync() noexcept override { return journal_.sync(); }
  int end(const Facts& facts, int64_t dropped) override { return journal_.end(facts, dropped); }

 private:
  static constexpr int64_t chunks_between_headings = 1000;
  JournalWriter journal_;
  int64_t chunks_ = 0;
};

/// Keeps rows in memory, up to a number of bytes; later rows are dropped and counted.
class MemorySink final : public LogSink {
 public:
  MemorySink(Recording heading, size_t most_bytes, size_t expected_rows) : recording_(std::move(heading)) {
    most_rows_ = most_bytes / (recording_.columns.size() * sizeof(double));
    for (Column& column : recording_.columns) column.values.reserve(std::min(most_rows_, expected_rows));
  }
  int take(std::span<const double> rows, int64_t) override {
    const size_t columns = recording_.columns.size();
    for (size_t at = 0; at < rows.size(); at += columns)
      if (recording_.rows() == most_rows_)
        ++dropped_;
      else
        for (size_t i = 0; i < columns; ++i) recording_.columns[i].values.push_back(rows[at + i]);
    return 0;
  }
  int64_t dropped() const { return dropped_; }
  Recording& recording() { return recording_; }

 private:
  Recording recording_;
  size_t most_rows_;
  int64_t dropped_ = 0;
};

}  // namespace loopwright::hw
