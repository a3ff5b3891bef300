/// Results of `loopwright design`: state feedback and Kalman filters for the linearization of a diagram.
#pragma once
#include <optional>
#include "models/linear/riccati.h"
#include "tools/linearize/linear_diagram.h"

namespace loopwright {

enum class DesignKind {
  regulator,  ///< u = -K x with the least Σ (or ∫) of weighted squares
  filter,     ///< the estimate of the states with the least variance
};

struct DesignRequest {
  DesignKind kind = DesignKind::regulator;
  /// Of a regulator: the commands. Of a filter: known inputs.
  std::vector<std::string> from;
  /// Of a filter: measured ports.
  std::vector<std::string> to;
  /// "NAME=NUMBER UNIT". Q: states or ports; R: commands, or measured ports. Regulator: weights of squares.
  /// Filter: variances of the noise, continuous: intensities.
  std::vector<std::string> Q, R;
  /// "NAME=NUMBER UNIT", states or ports. Regulator: the deviation x that counts as much as any other, with
  /// the weight 1/x² (A. E. Bryson, Y.-C. Ho, Applied Optimal Control, 1975). Filter: a standard deviation.
  std::vector<std::string> sizes;
  std::vector<std::string> without;  ///< blocks or states that do not belong to the plant
  bool keeps_loops = false;          ///< what drives the ports of `from` stays connected
  std::optional<double> at;          ///< s, of the operating point; none: the start
  bool continuous = false;           ///< only the continuous part, discrete signals held
  double sample_time = 0;            ///< s; of a continuous design: its exact sampled equivalent
};

struct DesignSignal {
  std::string name;
  std::optional<Unit> unit;  ///< nothing: not known
};

struct Design {
  DesignKind kind = DesignKind::regulator;
  std::string title, plan;                            ///< of the diagram: its title, its hash
  double time = 0;                                    ///< s, of the operating point
  std::vector<DesignSignal> states, inputs, outputs;  ///< outputs: of a filter
  StateSpace system;                                  ///< of a regulator: without outputs
  QuadraticCost cost;
  Regulator regulator;
  Filter filter;
  std::vector<std::string> left_out;  ///< states that nothing weighted, or nothing measured, depends on
  std::vector<LinearizationNote> notes;

  bool is_sampled() const { return system.sample_time > 0; }
  const std::vector<Pole>& poles() const {
    return kind == DesignKind::regulator ? regulator.poles : filter.poles;
  }
};

/// Throws InputError for names that do not exist, units that do not fit, several rates, and modes that cannot
/// be controlled or estimated; std::runtime_error if the run up to the operating point fails.
Design design(const Plan& plan, const DesignRequest& request, const RunOptions& options = {});

std::string to_text(const Design& design);
/// Stable keys: kind, title, plan, time, sample_time, states[], inputs[], outputs[], A, B, C, Q, R, N,
/// poles[], residual, left_out[], notes[]; of a regulator K, X; of a filter gain, predictor (if sampled), P.
std::string to_json(const Design& design);
/// A subdiagram: of a regulator a Gain for each state and command, of a sampled filter a Kalman block.
/// Throws InputError for a filter that this block cannot be.
std::string controller_diagram(const Design& design);
/// Short names of signals that are different from each other and may be names of ports.
std::vector<std::string> port_names(const std::vector<DesignSignal>& signals);

}  // namespace loopwright
