/// What a recording contains, before anything is concluded from it: columns, time, and what to ask about
/// them.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "tools/report/report.h"

namespace loopwright {

struct LookedColumn {
  std::string name, unit;  ///< as in the file; all numbers are in this unit
  size_t not_finite = 0;   ///< rows that hold no number
  std::string first_hole;  ///< the first cell that is no number at all, with its place; empty: there is none
  double least = 0, greatest = 0, mean = 0, deviation = 0;
  double resolution = 0;  ///< height of the steps in which it changes; 0: it has none
  double noise = 0;  ///< standard deviation, at most: fast changes of the signal count as noise; 0: not known
  size_t every = 1;  ///< rows from change to change of a signal that is held; 0: it hardly changes
  std::vector<size_t> outliers;  ///< rows, from 0
  double repeats_after = 0;      ///< [s] 0: it does not repeat, or the time is not even
  bool is_constant() const { return least == greatest; }
};

struct LookedTime {
  std::string column, unit;             ///< unit as in the file; empty: none, taken as s
  std::vector<double> at;               ///< [s]
  double sample_time = 0;               ///< [s]
  bool is_even = false;                 ///< all rows lie on one grid, some of which may be missing
  double jitter = 0, worst_jitter = 0;  ///< [s] deviation from the grid: standard deviation, and the greatest
  double digit = 0;                     ///< [s] last decimal digit of the stamps; 0: more than nine
  struct Gap {
    double behind = 0;    ///< [s]
    int64_t samples = 0;  ///< that are missing
  };
  std::vector<Gap> gaps;
  int64_t missing = 0;      ///< samples
  bool is_rounded = false;  ///< readers use the instants of the grid, not the stamps: unrounded()
};

/// A question that the recording raises.
struct Finding {
  std::string name;    ///< for programs: "time_not_named"
  std::string text;    ///< what was observed
  std::string advice;  ///< what it may mean, and what to do
};

struct Look {
  std::string path;
  size_t rows = 0;
  std::optional<LookedTime> time;     ///< nothing if no column can be the time
  std::vector<LookedColumn> columns;  ///< without the time
  std::vector<Finding> findings;
  Recording recording;
};

/// `time`: the name of the column with the time; empty: as every reader of recordings finds it. Throws
/// InputError if the file cannot be read. Cells without a number are counted, not refused.
Look look_at(const std::string& path, const std::string& time);

std::string to_text(const Look& look);
std::string to_json(const Look& look);
report::Page look_page(const Look& look);

}  // namespace loopwright
