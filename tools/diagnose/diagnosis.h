/// The answer of a diagnosis, as text, page and JSON present it.
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "tools/effects/insert_term.h"
#include "tools/report/report.h"

namespace loopwright {

struct DiagnosedParameter {
  std::string name, unit;
  double value = 0, low = 0, high = 0;  ///< SI; 95 % interval
  bool at_limit = false;                ///< the range of the catalogue ends here: a warning, not a result
  double times_a_turn = 0;              ///< of a pitch that is a whole part of a turn; 0: fitted
  bool is_linear = false;               ///< a size of the effect
  bool is_open = false;                 ///< the interval reaches the upper end of the catalogue's range
};

struct DiagnosedEffect {
  std::string name, form, title, physics;
  std::vector<DiagnosedParameter> parameters;
  std::vector<DiagnosedParameter> wave;   ///< amplitude and phase of a sine and a cosine; empty without them
  double inclusion = 0;                   ///< probability that it is present
  std::vector<std::string> alternatives;  ///< indistinguishable from it by this record
  double force_rms = 0;                   ///< SI
  double evidence = 0;                    ///< loss of the criterion without it
  bool is_optional = false;               ///< written into the improved diagram only on request
  // Without roles: where it acts, and on what it depends.
  std::string site, site_unit;
  std::vector<std::string> variables;
};

/// Parameters of a pattern, sine sin x + cosine cos x, in the files of effects.
inline constexpr std::string_view sine_name = "sine", cosine_name = "cosine";
/// What a reader is told: amplitude and phase in place of sine and cosine.
std::vector<DiagnosedParameter> told_parameters(const DiagnosedEffect& effect);

/// A parameter of the diagram that is not as the diagram states.
struct MovedParameter {
  std::string name, unit;
  double stated = 0, value = 0, low = 0, high = 0;  ///< SI; 95 % interval
};

/// Noise at a site that is alike for a while.
struct SlowDisturbance {
  std::string site, unit;
  double size = 0;   ///< [unit] rms
  double share = 0;  ///< of the signal there
  double time_s = 0;
};

/// Effects that explain the records equally well in place of some of the named ones.
struct OtherExplanation {
  std::vector<std::string> in_place_of, effects;
};

/// The errors with the effects up to this one.
struct DiagnosisStep {
  std::vector<std::string> added;
  double force_rmse = 0, held_out_force_rmse = 0;  ///< held out: see Diagnosis::holds_out; NaN: in no row
  double simulation_rmse = 0;  ///< of the measured signal, held out where there is a hold-out: see FreeRun
  bool is_optional = false;    ///< after the knee: small improvement
};

struct SuggestedExperiment {
  std::string text, between, and_effect;
};

/// A fault of the record that limits the conclusions.
struct RecordFinding {
  std::string what, cost;
  bool is_fatal = false;        ///< no confident verdict is possible from it
  bool may_be_physics = false;  ///< unless effects explain the whole record: then it has no meaning
};

/// An effect of the catalogue that cannot be used with this diagram or these records.
struct NotLookedFor {
  std::vector<std::string> effects;
  std::string why;
};

/// An effect that the prediction errors asked for, but that does not stand.
struct RefusedEffect {
  std::string effect, why;
  bool is_of_sensor = false;  ///< errors of a sensor that the diagram does not contain explain more
  bool is_blurred = false;    ///< late by a few rows, each of which stands for several: nothing is left of it
};

/// An effect that the records show with certainty, and that is too small to matter.
struct TooSmallEffect {
  std::string effect;
  double force_rms = 0;
  double share = 0;  ///< of the driving force
  double gain = 0;   ///< in twice the log-likelihood, less the price of its parameters
};

/// A share of the remaining error that a variable explains.
struct RemainderShare {
  std::string variable;
  double share = 0;
};

/// When most of the remaining error occurs.
struct RemainderInterval {
  size_t record = 1;  ///< which of the records, from 1
  double from_s = 0, to_s = 0;
};

/// An effect with its fitted parameters, as it can be added to the diagram.
struct AddedEffect {
  std::string name;  ///< as in the steps of the diagnosis
  Effect effect;
  std::vector<double> fitted;  ///< SI, in the order of the effect's file
  std::string note;            ///< the range of a function without a name
  std::optional<Term> term;    ///< without roles, in the place of `effect`
};
/// Effects that were found, fitted together, in the order in which they are added.
struct Additions {
  std::vector<AddedEffect> effects;
  std::vector<std::string> not_stated;  ///< functions without a name that no block can state: sentences
  std::vector<std::pair<std::string, double>> parameters;  ///< that moved: path as for `--set`, SI
  MachineUnits units;
  RecordSizes sizes;
};

/// The force that only this effect explains, over the variable that determines most of it. Without roles what
/// only this term explains at its site.
struct MissingTerm {
  std::string effect, site, variable, unit;  ///< site: a port of the diagram; unit: of the variable
  std::vector<double> at, found;        ///< what the diagram with all other effects leaves; NaN: not counted
  std::vector<double> shape_at, shape;  ///< force of the effect: means over narrow ranges of the variable
  std::string site_unit;
};

enum class Verdict { nothing_missing, explained, partly_explained, unexplained };
std::string_view name_of(Verdict verdict);

struct Diagnosis {
  Verdict verdict = Verdict::nothing_missing;
  std::string diagram, title;
  std::vector<std::string> experiments;
  std::vector<DiagnosedEffect> effects;              ///< strongest first
  std::vector<OtherExplanation> other_explanations;  ///< if more than one effect changes
  std::vector<DiagnosisStep> steps;                  ///< the first is the nominal diagram
  bool has_too_few_rows = false;                     ///< for any verdict
  bool holds_out = false;  ///< otherwise everything about held-out rows is 0 and not reported
  double error_before = 0, error_after = 0, noise_floor = 0;  ///< force, held out where there is a hold-out
  std::string force_unit, position_unit, measured_unit;
  std::vector<SuggestedExperiment> suggested;
  std::vector<RecordFinding> findings;
  std::vector<NotLookedFor> not_looked_for;
  std::string measured_port;  ///< without roles: that of the errors, the one that the diagram misses worst
  bool lacks_only_a_name = false;  ///< without roles: a function without a name explains all that was left
  bool has_roles = true;           ///< an axis; without roles any diagram, and no force is singled out
  std::vector<MovedParameter> moved_parameters;  ///< without roles
  std::vector<std::string> not_observable;       ///< without roles: sentences
  std::vector<RefusedEffect> refused;
  std::vector<TooSmallEffect> too_small;    ///< best first; all of them stand for one
  std::vector<std::string> contradictions;  ///< why the records are not explained although errors are white
  std::vector<std::string> remainder_variables;  ///< on which the remainder depends
  std::vector<RemainderShare> dependence;
  std::optional<RemainderInterval> remainder_interval;  ///< if it is a small part of a record
  bool was_interrupted = false;  ///< no other member has a meaning, nothing was written
  size_t rows = 0;               ///< fitted rows that count: those behind the verdict
  double mean_square = 0, held_out_mean_square = 0, portmanteau = 0;
  double white_force = 0, slow_force = 0, slow_force_time_s = 0;
  std::vector<double> measurement_noise;
  std::vector<SlowDisturbance> slow_disturbances;                 ///< without roles
  double simulation_horizon_s = 0;                                ///< after which each simulation begins anew
  bool is_simulated() const { return simulation_horizon_s > 0; }  ///< otherwise a map, or too short
  bool simulation_diverged = false;                               ///< of the diagram with all effects
  bool simulation_is_worse = false;                               ///< the same, than of the nominal diagram
  Additions additions;                                            ///< the effects that are not optional
  Additions all_additions;                                        ///< optional ones too, all fitted together
  std::string improved;                                           ///< the diagram that was written
  std::vector<std::string> improved_experiments;  ///< written for it, with the ports that it moved
  std::vector<std::string> taken_out_by;          ///< its parameters that take out one effect each when 0
  std::vector<std::string> improved_notes;        ///< how functions without a name are written
  std::vector<MovedPort> experiment_ports;  ///< that an experiment must name differently with that diagram
  std::vector<std::string> trail;
  struct Curves {
    std::vector<double> time, position, velocity, before, after;
  } curves;  ///< force residuals of the first record; a map has neither times nor speeds
  std::vector<MissingTerm> terms;  ///< of the effects that are not optional, in the first record
  struct Whiteness {
    std::vector<double> lag_s, before, after;  ///< correlation of prediction errors so far apart
    std::string port;                          ///< without roles: the output, the one that is least white
    double most = 0;                           ///< 95 % of the correlations of white errors are smaller
  } whiteness;
  report::Graph picture;  ///< the improved diagram; empty without effects
};

/// Stable keys, docs/diagnose.md.
std::string to_json(const Diagnosis& diagnosis);
std::string to_text(const Diagnosis& diagnosis);
/// to_text() without roles.
std::string any_diagram_text(const Diagnosis& diagnosis);
report::Page diagnosis_page(const Diagnosis& diagnosis);
/// diagnosis_page() without roles.
report::Page any_diagram_page(const Diagnosis& diagnosis);

}  // namespace loopwright
