/// The paper on data-driven compensation for core-type linear motors (TISO-GPR with a disturbance observer),
/// from the identification experiment to its tables and figures, and an improved method.
///
/// No number here is taken from the paper except `published`, which is shown beside the results in the page.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>
#include "tools/studies/linear_motor/frequency_response.h"
#include "tools/studies/linear_motor/runs.h"
#include "tools/studies/linear_motor/statements.h"
#include "tools/studies/linear_motor/training.h"
#include "tools/report/report.h"

namespace loopwright::paper {

struct Published {
  std::array<double, 3> table1_ds{0.3789, 0.2840, 0.1550}, table1_ps{0.1516, 0.1506, 0.1493};  // V
  double conventional = 42.048e-6, ds = 29.228e-6, ps = 22.408e-6;                             // m
};
inline constexpr Published published;

struct StudyOptions {
  std::string diagrams = "diagrams/linear_motor";
  std::string output = "build/paper";  ///< folder for recordings and models
  int runs = 5;                        ///< with different noise, for every number
  std::function<void(const std::string& what)> progress;
};

/// Tracking errors [m] of several controllers under one condition.
struct Tracking {
  Condition condition;
  std::vector<Spread> errors;  ///< in the order of the controllers
};

struct Comparison {
  std::vector<Controller> controllers;
  std::vector<Tracking> rows;
  /// Throws std::out_of_range when the key is unknown.
  const Spread& at(std::string_view condition, std::string_view controller) const;
};

/// Predictions on experiments not used for training [V]; by size of the training windows.
struct PredictionErrors {
  std::array<Spread, 3> ds, ps;                      ///< against the observer's estimate: Table 1
  std::array<Spread, 3> undelayed_ds, undelayed_ps;  ///< against labels without delay
};

struct Study {
  int runs = 0;
  Models models;
  std::vector<Stretch> trained;  ///< positions of D2
  PredictionErrors prediction;
  Comparison comparison;      ///< conventional, DS, PS and beyond, under every condition
  Comparison steps;           ///< from PS to beyond, one change at a time
  Comparison variance_aware;  ///< each with plain and with variance-aware estimate
  Comparison payloads;        ///< conventional, DS, PS over payloads
  Comparison retuned;         ///< the conventional controller with a faster observer
  FigureRuns figures;
  Recording beyond;  ///< the paper's motion
  FrequencyResponse response;
  std::vector<Statement> statements;
};

// The parts of a study. Noise differs between training, evaluation and tracking, and from run to run.

/// Records the identification experiment as a CSV file in `folder` and returns its path. Training and
/// evaluation experiments have different noise; `run` counts from 0.
enum class Purpose { training, evaluation };
std::string record_experiment(const std::string& diagrams, Purpose purpose, int run,
                              const std::string& folder);
/// Each run trains on an experiment of its own and evaluates on another; their recordings are written to
/// `folder`. The models of the first run are passed in.
PredictionErrors prediction_errors(const std::string& diagrams, const Models& first, int runs,
                                   const std::string& folder);
/// Conventional, DS, PS, beyond.
std::vector<Controller> controllers_of(const std::string& diagrams, const Models& models);
Comparison compare(std::vector<Controller> controllers, std::vector<Condition> conditions, int runs);
FigureRuns figure_runs(const std::vector<Controller>& controllers);

/// The complete study: simulates, trains, simulates again. The same options give the same numbers.
Study run_study(const StudyOptions& options);

/// Stable keys: table1.{ds,ps}[3] in V; table2.{conventional,ds,ps,beyond} in µm on the paper's motion;
/// held_out, payload2x, delay1, homing1mm .{conventional,ds,ps,beyond} in µm on the held-out motion.
std::string to_json(const Study& study);
report::Page study_page(const Study& study);
/// Only tables and statements.
report::Page summary_page(const Study& study);

}  // namespace loopwright::paper
