#include "tools/run/judged_run.h"

namespace loopwright {
namespace {

std::vector<FollowedSignal> pairs_to_judge(const Diagram* diagram, const Plan& plan) {
  if (!diagram) return guessed_signals(plan);
  Problems problems;
  std::vector<FollowedSignal> followed = followed_signals(*diagram, plan, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  return followed;
}

}  // namespace

JudgedRun run_and_judge(const Diagram* diagram, const Plan& plan, const RunOptions& options) {
  const std::vector<FollowedSignal> followed = pairs_to_judge(diagram, plan);
  const WatchedLimits limits(plan);
  const bool is_watched = options.checkpoint_file.empty() && options.resume_file.empty();
  JudgedRun run{simulate(is_watched ? limits.plan() : plan, options), {}};
  std::vector<TimeAtLimit> at_limits;
  if (is_watched) at_limits = limits.take(run.result.recording);
  run.figures = run_figures(followed, run.result.recording, std::move(at_limits));
  run.figures.limits_not_watched = limits.left_out() + (is_watched ? 0 : limits.watched());
  return run;
}

}  // namespace loopwright
