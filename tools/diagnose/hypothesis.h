/// A model under test: the nominal diagram and some effects, run along every record.
#pragma once
#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include "tools/diagnose/candidate.h"

namespace loopwright::diagnosis {

/// Somebody does not want to wait any longer.
struct Interrupted {};

/// One record with the model that follows it.
struct Trial {
  std::unique_ptr<AxisModel> model;
  std::vector<char> moving;   ///< rows while moving for a while, past the start, not damaged
  std::vector<char> usable;   ///< of these the ones that count: see leave_out_doubtful()
  std::vector<char> at_rest;  ///< rows at rest, past the start
  size_t held_out_from = 0;   ///< rows from here on are not fitted
  std::vector<double> input;  ///< as recorded, over the rows that a model is run along: see run_along

  size_t rows() const { return input.size(); }
};

/// The records of one axis, and what is known about their noise.
struct Trials {
  std::vector<Trial> list;
  Noise noise;
  double rest_speed = 0;
  bool nominal_holds = false;  ///< the user's diagram has dry friction that holds the axis
  double force_rms = 0;        ///< what the recorded inputs make of force
  double lowest_position = 0, highest_position = 0, longest_s = 0;  ///< as the first prediction saw them
  const std::atomic<bool>* interrupt =
      nullptr;  ///< once true, the next run along the records throws Interrupted
  size_t ports() const { return list.front().model->record().measured.size(); }
  /// All records are maps of balances, or none.
  bool has_map() const { return list.front().model->record().is_map; }

  /// What is not fitted need not be run along while a set is searched for.
  enum class Rows { fitted, all };
  void run_along(Rows rows);
};

/// What the blocks of effects run on: the motion that one prediction saw. Two sets of effects can be held
/// against each other on the same motion; on different ones even the same set differs a little.
struct Motion {
  std::vector<std::shared_ptr<const Path>> paths;            ///< of each record
  double profile = std::numeric_limits<double>::infinity();  ///< of the prediction that saw it
};

/// The rows of a motion that the trials are run along; it must have as many.
Motion cut(const Motion& motion, const Trials& trials);

/// What the members make of one record.
struct Fitted {
  LinearAxis axis;
  Gains gains;
  Prediction prediction;
  std::vector<double> white;  ///< whitened errors
};

/// Runs the nominal diagram with the members along each record, as far as the trials say; without members no
/// motion is needed.
std::vector<Fitted> run_members(Trials& trials, const std::vector<Member>& members, const Motion& motion,
                                const Noise& noise);

/// The input behind the members that change it, and what the others consume, along a path.
Drives drives_of(const std::vector<Member>& members, const Path& path, const std::vector<double>& raw_input);

/// Mean of the squared whitened errors over the usable rows before the hold-out, or in it.
double mean_square(const Trials& trials, const std::vector<Fitted>& fitted, bool held_out = false);
/// n ln(mean square) + Σ ln |S| over the fitted rows: twice the negative log-likelihood, the best common
/// scale of all noise put in.
double profile(const Trials& trials, const std::vector<Fitted>& fitted);
/// Rows × ports that are fitted.
size_t fitted_numbers(const Trials& trials);

/// Derivatives of the whitened prediction errors, negated: what one more unit of each parameter adds to them.
/// One column a parameter, linear ones of a member first.
struct Sensitivity {
  std::vector<std::vector<double>> columns;  ///< samples × ports each
};
Sensitivity sensitivity(const std::vector<Member>& members, const Path& path, const Fitted& fitted,
                        const std::vector<double>& raw_input);

/// The parameters that are free in a fit, in order.
struct FreeParameter {
  size_t member;
  bool is_linear;
  size_t index;
};
std::vector<FreeParameter> free_parameters(const std::vector<Member>& members);
double& value_of(std::vector<Member>& members, const FreeParameter& parameter);
const CandidateParameter& range_of(const std::vector<Member>& members, const FreeParameter& parameter);

}  // namespace loopwright::diagnosis
