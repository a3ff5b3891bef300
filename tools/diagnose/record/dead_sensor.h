/// Sensors that do not answer: unplugged, frozen, or of another machine.
#pragma once
#include <span>
#include "tools/experiment/experiment.h"

namespace loopwright::diagnosis {

/// A problem if a measured signal has one value throughout: a model that did not answer its inputs either
/// would agree with it.
void reject_if_constant(const RecordedSignal& compared, const Column& column, Problems& problems);

/// Whether a signal changes as much from row to row as over the whole record: Σ(x[k+1] - x[k])² over
/// Σ(x[k] - mean)² is 2 for white noise, and 4 sin²(π/N) for a motion of N rows a period (von Neumann, 1941).
bool is_noise_alone(std::span<const double> values);

}  // namespace loopwright::diagnosis
