/// One simulation from start to stop: fixed or variable step, events, recording, checkpoints.
#pragma once
#include <atomic>
#include <functional>
#include "engine/record/recording.h"
#include "engine/run/run.h"

namespace loopwright {

struct RunOptions {
  int64_t run = 0;              ///< number of the run: each run has different noise
  std::string checkpoint_file;  ///< written during the run; empty: none
  double checkpoint_every = 0;  ///< [s] of simulated time; written after the next step, without changing it
  std::string resume_file;      ///< continue from this checkpoint
  const std::atomic<bool>* interrupt = nullptr;            ///< set by a signal handler: stop after this step
  std::function<void(double time, double stop)> progress;  ///< called occasionally between steps
  std::function<void(Run<double>&)> at_stop;               ///< called at the stop time, with signals computed
};

enum class RunStatus { finished, failed, interrupted };

struct CrossingCount {
  std::string name;  ///< "relay.threshold"
  int64_t events = 0;
};

struct RunStatistics {
  int64_t steps = 0;  ///< of the solver
  int64_t rejected_steps = 0;
  int64_t derivative_evaluations = 0;
  int64_t restarts = 0;  ///< after samples, events and known discontinuities
  int64_t rows = 0;
  double wall_seconds = 0;
  double largest_pole = 0;  ///< [rad/s] largest |λ| of the continuous part at the start; 0: not known
  std::vector<CrossingCount> events;
};

struct RunResult {
  RunStatus status = RunStatus::finished;
  double time = 0;      ///< [s] time reached
  std::string message;  ///< why the run did not finish: block, time, reason, possible remedy
  Recording recording;  ///< the computed rows, also after a failure
  RunStatistics statistics;
  std::vector<std::string> warnings;
};

/// Runs the plan from its start to its stop time. Numerical failures are reported in the result. A checkpoint
/// file that cannot be read or does not belong to the plan throws InputError.
RunResult simulate(const Plan& plan, const RunOptions& options = {});

}  // namespace loopwright
