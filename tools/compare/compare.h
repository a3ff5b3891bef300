/// A model held against a recording: how far off is it, and where.
#pragma once
#include "engine/run/simulation.h"
#include "tools/compare/experiment.h"
#include "tools/report/report.h"

namespace loopwright {

/// One compared signal: measured, simulated, and the difference simulated - measured, at the recorded times.
struct ComparedSignal {
  std::string name, unit;   ///< SI
  std::vector<double> measured, simulated, error;
  double rmse = 0, max_abs = 0, mean = 0;
  double relative_percent = 0;  ///< 100 · rms(error) / rms(measured)
  double fit_percent = 0;       ///< 100 · (1 - ‖y - ŷ‖ / ‖y - mean y‖)
  double held_out_rmse = 0;     ///< over the rows kept out; 0 without
  double resolution = 0;
};

struct Comparison {
  std::vector<double> time;     ///< s
  std::vector<ComparedSignal> signals;
  std::vector<double> position, velocity;  ///< measured or simulated, by the roles; empty: not known
  std::string position_unit, velocity_unit, position_source, velocity_source;
  RunResult run;
  std::shared_ptr<const Plan> plan;
  std::vector<std::string> warnings;
};

/// Runs the diagram along the experiment. Throws InputError with every problem of diagram and experiment.
Comparison compare(const std::string& diagram, const std::string& experiment, const LoadOptions& options = {},
                   const RunOptions& run_options = {});

/// Stable keys: signals.<name>.{rmse,max_abs,mean,relative_percent,fit_percent,unit}.
std::string to_json(const Comparison& comparison);
std::string to_text(const Comparison& comparison);
report::Page comparison_page(const Comparison& comparison, const std::string& title);

}  // namespace loopwright
