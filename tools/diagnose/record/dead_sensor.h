/// Sensors that do not answer: unplugged, frozen, or of another machine.
#pragma once
#include <span>
#include "tools/experiment/experiment.h"

namespace loopwright::diagnosis {

/// A problem if a measured signal has one value throughout: a model that did not answer its inputs either
/// would agree with it.
void reject_if_constant(const RecordedSignal& compared, const loopwright::Column& column, Problems& problems);

/// Rows in which an angle leaps by a turn, because its sensor begins anew there. One that turns by a half
/// within a row somewhere may well turn so fast: then none.
size_t leaps_by_a_turn(std::span<const double> angle_rad);

/// Whether a signal changes as much from row to row as over the whole record: Σ(x[k+1] - x[k])² over
/// Σ(x[k] - mean)² is 2 for white noise, and 4 sin²(π/N) for a motion of N rows a period (von Neumann, 1941).
bool is_noise_alone(std::span<const double> values);

}  // namespace loopwright::diagnosis
