/// A model to be tested: the nominal diagram and some effects, run along every record.
#pragma once
#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include "tools/diagnose/predict/flying_load.h"
#include "tools/diagnose/search/candidate.h"
#include "tools/diagnose/predict/work.h"

namespace loopwright::diagnosis {

/// The user requested an interruption.
struct Interrupted {};

struct InverseDynamics;
class RememberedRuns;

/// One record with the model that follows it.
struct Trial {
  std::unique_ptr<AxisModel> model;
  Pace pace;
  size_t settled_from = 0;   ///< first row at which the predictor has forgotten its start
  std::vector<char> moving;  ///< rows that have been moving for some time, after the start, not damaged
  std::vector<char> with_reversals;  ///< instead of them, where they chose a law: see FrictionAtReversals
  std::vector<char> usable;          ///< those of them that count: see leave_out_doubtful()
  std::vector<char> at_rest;         ///< rows at rest, after the start
  size_t held_out_from = 0;          ///< rows from here on are not fitted
  std::vector<double> input;         ///< as recorded, over the rows that a model is run along: see run_along

  size_t rows() const { return input.size(); }
  const std::vector<char>& certain() const { return with_reversals.empty() ? moving : with_reversals; }
};

/// The records of one axis, and what is known of their noise.
struct Trials {
  std::vector<Trial> list;
  Noise noise;
  bool nominal_holds = false;  ///< the user's diagram has dry friction, in one of the records
  double force_rms = 0;        ///< of the force that the recorded inputs produce, about its mean
  double usual_force = 0;      ///< what it exceeds in a tenth of the motion; where that is more, its rms
  bool noise_is_seen = false;  ///< the errors of the nominal diagram are white with the noise fitted to them
  double lowest_position = 0, highest_position = 0, longest_s = 0;  ///< as in the first prediction
  const std::vector<InverseDynamics>* inverse = nullptr;            ///< of each record; null: not yet known
  /// Loads that fly are states of the predictor. During the search they move along the path instead: a set
  /// in search of them would lose its other errors to where the load is.
  bool follows_flights = true;
  double turn = 0;  ///< [position] after which everything on a rotary axis repeats; 0: not rotary
  const std::atomic<bool>* interrupt =
      nullptr;  ///< once true, the next run along the records throws Interrupted
  std::function<void(const std::vector<Member>&)> found;  ///< told of every set that the search accepts
  std::shared_ptr<RememberedRuns> remembered;             ///< never null
  std::shared_ptr<Work> work = std::make_shared<Work>();  ///< done so far, and its limit
  size_t ports() const { return list.front().model->record().measured.size(); }
  /// All records are maps of balances, or none.
  bool has_map() const { return list.front().model->record().is_map; }
  /// The diagram has a mass to which more can be added.
  bool has_mass() const { return list.front().model->has_mass(); }

  /// During the search for a set, rows that are not fitted need not be run along.
  enum class Rows { fitted, all };
  void run_along(Rows rows);
};

/// The input of the effects' blocks: the motion estimated by one prediction. Two sets of effects can be
/// compared on the same motion; on different motions even the same set gives slightly different values.
struct Motion {
  std::vector<std::shared_ptr<const Path>> paths;            ///< one per record
  double profile = std::numeric_limits<double>::infinity();  ///< of the prediction that estimated it
};

/// The rows of a motion that the trials are run along; it must have this many.
Motion cut(const Motion& motion, const Trials& trials);

/// The result of the members on one record.
struct Fitted {
  LinearAxis axis;
  Gains gains;
  Prediction prediction;
  std::vector<double> white;          ///< whitened errors
  const Candidate* flying = nullptr;  ///< the member whose load is a state of the predictor
  std::shared_ptr<const Flight> flight;
};
/// Of every record. They do not change, and estimates share them.
using Results = std::shared_ptr<const std::vector<Fitted>>;

/// Runs the nominal diagram with the members along each record, as far as the trials require; without members
/// no motion is needed.
std::vector<Fitted> run_members(Trials& trials, const std::vector<Member>& members, const Motion& motion,
                                const Noise& noise);

/// What the members add to the mass of the model; that of a load of its own is negative.
double added_inertia(const std::vector<Member>& members);

/// The input after the members that change it, and the force that the others consume, along a path.
/// `without`: one of them that the predictor itself follows.
Drives drives_of(const std::vector<Member>& members, const Path& path, const std::vector<double>& raw_input,
                 const Member* without = nullptr);

/// Mean of the squared whitened errors over the usable rows before the hold-out, or in it.
double mean_square(const Trials& trials, const std::vector<Fitted>& fitted, bool held_out = false);
/// n ln(mean square) + Σ ln |S| over the fitted rows: twice the negative log-likelihood with the best common
/// scale of all noise inserted.
double profile(const Trials& trials, const std::vector<Fitted>& fitted);
/// Number of fitted rows × ports.
size_t fitted_numbers(const Trials& trials);

/// Derivatives of the whitened prediction errors, negated: the change caused by one more unit of each
/// parameter. One column per parameter, linear ones of a member first.
struct Sensitivity {
  std::vector<std::vector<double>> columns;  ///< samples × ports each
};
Sensitivity sensitivity(const std::vector<Member>& members, const Path& path, const Fitted& fitted,
                        const std::vector<double>& raw_input);

/// The free parameters of a fit, in order.
struct FreeParameter {
  size_t member;
  bool is_linear;
  size_t index;
  bool operator==(const FreeParameter&) const = default;
};
std::vector<FreeParameter> free_parameters(const std::vector<Member>& members);
double& value_of(std::vector<Member>& members, const FreeParameter& parameter);
const CandidateParameter& range_of(const std::vector<Member>& members, const FreeParameter& parameter);
/// Whether it is the period of a sine and a cosine.
bool is_period(const Member& member, const FreeParameter& parameter);
/// A period changes with the phase at the middle of the record kept: far from zero, a small change of it
/// would otherwise shift the pattern by many periods. Derivatives with respect to a period are meant so too.
void set_value(std::vector<Member>& members, const FreeParameter& parameter, double value);

}  // namespace loopwright::diagnosis
