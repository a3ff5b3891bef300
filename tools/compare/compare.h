/// Compares a model with a recording: how large the errors are, and where they occur.
#pragma once
#include "engine/run/simulation.h"
#include "tools/compare/excitation.h"
#include "tools/experiment/experiment.h"
#include "tools/compare/missing_force.h"
#include "tools/report/report.h"

namespace loopwright {

/// One compared signal: measured, simulated, and the difference simulated - measured, at the recorded times
/// that have a reading of it.
struct ComparedSignal {
  std::string name, unit;  ///< SI
  std::vector<double> measured, simulated, error;
  SlowerRows rows;  ///< of the record, at which these are
  double rmse = 0, max_abs = 0, mean = 0;
  double relative_percent = 0;  ///< 100 · rms(error) / rms(measured)
  double fit_percent = 0;       ///< 100 · (1 - ‖y - ŷ‖ / ‖y - mean y‖)
  double held_out_rmse = 0;  ///< over the held-out rows of the record; 0 without, or if not all were reached
  double resolution = 0;
};

/// Root mean squared error of the position when the model is driven by the recorded input.
struct OpenLoopErrors {
  double whole_record = 0;                           ///< [position] started once: the errors accumulate
  std::vector<std::pair<double, double>> restarted;  ///< horizon [s] → error [position] over all of its rows
};

/// What the machine's record shows in addition to its signals.
struct ForceAnalysis {
  MeasuredMotion motion;
  double mass = 0;  ///< [force s²/position] of the model
  ForceResidual residual;
  std::vector<ResidualShare> where;
  std::vector<Dependence> dependence;
  OpenLoopErrors open_loop;
  RecordContent content;
  std::vector<Identifiability> identifiable;
  std::vector<RecordFault> faults;
};

struct Comparison {
  std::vector<double> time;     ///< s
  int64_t missing_samples = 0;  ///< between rows of the recording: a held input was held there
  std::vector<ComparedSignal> signals;
  /// Of each row: of a slower signal they are simulated.
  std::vector<double> position, velocity;  ///< measured or simulated, according to the roles; empty: unknown
  std::string position_unit, velocity_unit, position_source, velocity_source;
  RunResult run;
  std::shared_ptr<const Diagram> diagram;
  std::shared_ptr<const Plan> plan;  ///< compiled from it
  std::optional<ForceAnalysis> force;
  std::string why_no_force;     ///< what the experiment lacks for it
  bool lacks_held_out = false;  ///< rows are held out, and the run ended before the last of them
  bool is_closed_loop = false;  ///< the signals above are those of the whole loop: its input was not driven
  std::vector<std::string> warnings;
};

/// Runs the diagram along the experiment. Throws InputError with every problem of diagram and experiment.
Comparison compare(const std::string& diagram, const std::string& experiment, const LoadOptions& options = {},
                   const RunOptions& run_options = {});

/// The same without the analysis of forces: only the signals.
Comparison compare_signals(const std::string& diagram, const Experiment& experiment,
                           const LoadOptions& options = {}, const RunOptions& run_options = {});

/// The same for a diagram file whose text is in memory.
Comparison compare_signals(const std::shared_ptr<const SourceFile>& diagram, const Experiment& experiment,
                           const LoadOptions& options = {}, const RunOptions& run_options = {});

/// Why a comparison with lacks_held_out has no figure for the rows that were held out.
inline constexpr std::string_view no_held_out =
    "the run ended before the rows that are held out did: no error of theirs is given";

/// Stable keys: signals.<name>.{rmse,max_abs,mean,relative_percent,fit_percent,unit},
/// force_residual.{rmse,relative_percent,noise_floor,unit}, where[].{axis,from,to,share},
/// dependence.<variable>, simulation, excitation and faults.
std::string to_json(const Comparison& comparison);
std::string to_text(const Comparison& comparison);
/// The part of the page about forces; empty without an analysis.
std::vector<report::Section> force_sections(const Comparison& comparison);
report::Page comparison_page(const Comparison& comparison, const std::string& title);

}  // namespace loopwright
