/// What a run shows about a control loop, in words and numbers.
#pragma once
#include "engine/run/simulation.h"
#include "tools/report/report.h"
#include "tools/run/figures.h"
#include "tools/run/limits.h"

namespace loopwright {

/// What is judged beside the recording itself.
struct RunFigures {
  std::vector<TrackingFigures> tracking;
  std::vector<TimeAtLimit> limits;
  size_t limits_not_watched = 0;      ///< outputs with limits of which nothing is known
  std::vector<std::string> swinging;  ///< logged signals that build up, where no reference is known
};

/// Computes the figures of the pairs from followed_signals; `limits` comes from WatchedLimits. For a run as a
/// whole: run_and_judge().
RunFigures run_figures(const std::vector<FollowedSignal>& followed, const Recording& recording,
                       std::vector<TimeAtLimit> limits);

/// The most important sentence first: failed, unstable, not settled, at a limit, or good.
std::vector<report::Notice> verdict(const Plan& plan, const RunResult& result, const RunFigures& figures);

/// Error, overshoot, settling of the first pairs, and the time at limits.
report::KeyNumbers key_numbers(const RunFigures& figures);

/// The same for a terminal, a line for each pair and limit.
std::string figures_text(const RunFigures& figures);

}  // namespace loopwright
