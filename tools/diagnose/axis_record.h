/// What was recorded of one axis, in the form that the predictor reads: one input held from sample to sample,
/// and the measured position and velocity.
#pragma once
#include <array>
#include <string>
#include <vector>
#include "engine/plan/plan.h"
#include "tools/compare/experiment.h"

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
  double sample_time = 0;             ///< s
  double start = 0;                   ///< s
  std::vector<double> recorded_time;  ///< s; of the rows as they were
  std::vector<double> input;          ///< SI; held from its sample to the next
  std::string input_unit;
  std::vector<MeasuredPort> measured;  ///< position first; at least one
  bool is_map = false;                 ///< rows are balances, each by itself: see gather_balances
  size_t held_out_from = 0;            ///< first row kept out of the identification; rows() without hold-out

  size_t rows() const { return input.size(); }
  const MeasuredPort* find(std::string_view role) const {
    for (const MeasuredPort& port : measured)
      if (port.role == role) return &port;
    return nullptr;
  }
};

/// The columns that belong to the roles, on an even grid. Rows missing in an uneven record are filled by
/// holding the input and joining the measured values by straight lines.
/// Problems: roles or columns that are missing, other units than the diagram's.
AxisRecord read_axis_record(const Experiment& experiment, const Plan& plan, Problems& problems);

/// The experiment with the axis cut open at its input: the measured input alone drives the diagram.
Experiment cut_open(const Experiment& experiment, const Plan& plan, Problems& problems);

}  // namespace loopwright::diagnosis
