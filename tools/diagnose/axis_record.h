/// What was recorded of one axis, in the form that the predictor reads: one input held from sample to sample,
/// and the measured position and velocity.
#pragma once
#include <array>
#include <string>
#include <vector>
#include "engine/plan/plan.h"
#include "tools/compare/machine.h"

namespace loopwright::diagnosis {

/// A port that was measured.
struct MeasuredPort {
  std::string role;  ///< "position" or "velocity"
  Number number = -1;
  std::string unit;           ///< SI
  double resolution = 0;      ///< SI; 0: not known
  std::vector<double> value;  ///< SI, a sample each
};

struct AxisRecord {
  std::string title, path;
  double sample_time = 0;     ///< s
  double start = 0;           ///< s
  std::vector<char> missing;  ///< samples that were not recorded; empty: none
  std::vector<double> input;  ///< SI; held from its sample to the next
  std::string input_unit;
  std::vector<MeasuredPort> measured;  ///< position first; at least one
  bool is_map = false;                 ///< rows are balances, each by itself: see gather_balances
  size_t held_out_from = 0;            ///< first row kept out of the identification; rows() without hold-out

  size_t rows() const { return input.size(); }
  bool is_missing(size_t row) const { return !missing.empty() && missing[row]; }
  const MeasuredPort* find(std::string_view role) const {
    for (const MeasuredPort& port : measured)
      if (port.role == role) return &port;
    return nullptr;
  }
};

/// Position, velocity and acceleration below the cut-off, and the input; what it makes of force only the
/// model knows.
MeasuredMotion measured_motion(const AxisRecord& record);

/// The columns that belong to the roles, on an even grid: see EvenGrid.
/// Problems: roles or columns that are missing, other units than the diagram's.
AxisRecord read_axis_record(const Experiment& experiment, const Plan& plan, Problems& problems);

/// The experiment with the axis cut open at its input: the measured input alone drives the diagram.
Experiment cut_open(const Experiment& experiment, const Plan& plan, Problems& problems);

}  // namespace loopwright::diagnosis
