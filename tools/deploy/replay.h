/// Proof that a log and a plan explain each other: the plan is run on what the log measured, and must put out
/// what the log holds, bit for bit.
#pragma once
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "hw/realtime/axes.h"

namespace loopwright {

/// A computed column of the log beside its replay.
struct ReplayedColumn {
  std::string name, unit;
  int64_t differing = 0;   ///< rows whose bits differ
  double largest = 0;      ///< largest difference
  int64_t first_row = -1;  ///< that differs; -1: none
  double first_time = 0;   ///< s
};

struct Replay {
  int64_t rows = 0;  ///< replayed
  std::vector<ReplayedColumn> columns;
  std::string fault;      ///< why it ended before the log did; empty: it did not
  std::string other_build;  ///< says so where another build of the program made the log; empty: this one did
  bool explains() const;  ///< every row was replayed and every bit is the same
};

/// Steps the plan through the rows of the log. Problems: a column that is needed is not in the log; the log was
/// made by other parameters, or with other contents of a file.
Replay replay(const Plan& plan, const hw::Hardware& hardware, const Recording& log, Problems& problems);

/// A few lines for a terminal.
std::string to_text(const Replay& replay);

}  // namespace loopwright
