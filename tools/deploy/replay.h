/// Verifies that a log and a plan are consistent: the plan is run on the measurements of the log and must
/// reproduce the outputs of the log bit for bit, and what the device applied must be these outputs within the
/// limits of the device file. The measurements themselves, and the times that the loop took, cannot be
/// verified.
#pragma once
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "hw/realtime/axes.h"

namespace loopwright {

/// A computed column of the log with its replay.
struct ReplayedColumn {
  std::string name, unit;
  int64_t differing = 0;   ///< rows whose bits differ
  double largest = 0;      ///< largest difference
  int64_t first_row = -1;  ///< first one that differs; -1: none
  double first_time = 0;   ///< s
};

struct Replay {
  int64_t rows = 0;  ///< rows replayed
  std::vector<ReplayedColumn> columns;
  std::string fault;  ///< why it ended before the log did, or which rows the log lacks; empty: neither
  std::vector<std::string> taken;  ///< columns and facts of the log that nothing here can verify
  std::string incomplete;   ///< why the run ended before the plan's end, as the log states; empty: it did not
  std::string other_build;  ///< reports that another build of the program wrote the log; empty: this one did
  bool explains() const;    ///< every row was replayed and all bits are equal
};

/// Steps the plan through the rows of the log. Problems: a required column is missing in the log; the log was
/// made with other parameters, or with other contents of a file.
Replay replay(const Plan& plan, const hw::Hardware& hardware, const Recording& log, Problems& problems);

/// A few lines for a terminal.
std::string to_text(const Replay& replay);

}  // namespace loopwright
