/// Records that are too long for a search that passes over them thousands of times.
#pragma once
#include <optional>
#include <vector>
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/record/signal_record.h"

namespace loopwright::diagnosis {

/// Leaves at most `most_rows` rows in all records together, and says how; nothing if there are not more.
///
/// Means of neighboring rows stand for them, of inputs and outputs alike: a linear plant answers the mean of
/// its input by the mean of its output, so that the record still fits, and what is faster is not aliased. If
/// that would average an output away, the first rows are taken instead.
std::optional<RecordFinding> shorten(std::vector<SignalRecord>& records, size_t most_rows);

}  // namespace loopwright::diagnosis
