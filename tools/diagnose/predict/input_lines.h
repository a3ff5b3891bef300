/// A recorded input between its rows, and what a machine makes of it that gets it late.
#pragma once
#include <vector>
#include "tools/diagnose/record/signal_record.h"

namespace loopwright::diagnosis {

/// Over the sample that begins at a row: value + slope · (t - t_row).
struct InputLine {
  double value = 0, slope = 0;
};
using InputLines = std::vector<InputLine>;  ///< one for each row

/// As it was recorded, between its rows as the experiment states.
InputLines lines_of(const SignalRecord& record, const RecordedInput& input);

/// u(t - delay): over each sample the line with the same mean and first moment. `before`: what the input was
/// before each record.
InputLines delayed(const SignalRecord& record, const InputLines& input, double delay, double before);

/// z of time_constant · z' = u - z, at rest before each record; lines as for `delayed`.
InputLines lagged(const SignalRecord& record, const InputLines& input, double time_constant, double before);

/// What the first has more than the second, row by row.
InputLines difference(InputLines first, const InputLines& second);

}  // namespace loopwright::diagnosis
