/// The record of one axis in the form that the predictor reads: one input over each sample, and the measured
/// position and velocity.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>
#include "engine/plan/plan.h"
#include "tools/compare/machine.h"
#include "tools/experiment/false_readings.h"

namespace loopwright::diagnosis {

/// A measured port.
struct MeasuredPort {
  std::string role;  ///< "position" or "velocity"
  Number number = -1;
  std::string unit;           ///< SI
  double resolution = 0;      ///< SI; 0: unknown
  std::vector<double> value;  ///< SI, one value per sample
  SlowerRows rows{};          ///< of the file, which have a reading
};

struct AxisRecord {
  std::string title, path;
  Place place;                ///< of the experiment's object
  double sample_time = 0;     ///< s
  double start = 0;           ///< s
  std::vector<char> missing;  ///< samples that were not recorded; empty: none
  std::vector<double> input;  ///< SI; the mean from its sample to the next
  /// From its sample to the next, the change of the line with the mean and the first moment of the input;
  /// empty: the input is held.
  std::vector<double> input_slope;
  /// [sample times] From each row to the next, where the rows were not sampled evenly; empty: 1.
  std::vector<double> duration;
  std::string input_unit;
  double first_position = 0;           ///< SI; of the diagram, where nobody measures the position
  std::vector<MeasuredPort> measured;  ///< position first; at least one
  bool is_map = false;                 ///< rows are independent balances: see gather_balances
  /// Rows whose readings are false, and replaced by what their neighbours say: see replace_readings. The
  /// predictor does not correct itself by them. Empty: none.
  std::vector<char> false_rows;
  size_t false_readings = 0;  ///< of all sensors
  InputLeaps leaps = InputLeaps::felt;
  size_t rows_late = 0;        ///< of the input, which is where it belongs now
  size_t input_leaps = 0;      ///< values of the input that are out of line, or were and were taken away
  size_t leaps_by_a_turn = 0;  ///< rows in which the angle begins anew, as recorded
  bool is_thinned = false;     ///< several recorded rows are one
  size_t rows_in_one = 1;      ///< of these, means over so many stand for them
  /// Role of a sensor that is read less often than the other one, and left out; empty: none.
  std::string left_out;
  /// The input changes while the sensor is not read: a controller then answers to what the record does not
  /// show yet.
  bool acts_between_readings = false;
  size_t held_out_from = 0;  ///< first row held out of the identification; rows() without hold-out

  size_t rows() const { return input.size(); }
  bool controller_may_know_more() const { return acts_between_readings || !left_out.empty(); }
  bool is_missing(size_t row) const { return !missing.empty() && missing[row]; }
  bool is_false(size_t row) const { return !false_rows.empty() && false_rows[row]; }
  const MeasuredPort* find(std::string_view role) const {
    for (const MeasuredPort& port : measured)
      if (port.role == role) return &port;
    return nullptr;
  }
};

/// [sample times] Where the rows lie.
std::vector<double> places_of_rows(const AxisRecord& record);

/// Position, velocity and acceleration below the cut-off, and the input. The force that it produces is known
/// only to the model.
MeasuredMotion measured_motion(const AxisRecord& record);

/// What a recorded input has that the machine does not feel.
struct InputCorrection {
  double rows = 0, share = 0;  ///< noise: a share of what it is above its mean over some rows on both sides
  InputLeaps leaps = InputLeaps::felt;
  size_t rows_late = 0;  ///< each value belongs to so many rows before; not where rows become one
};
/// Means of each row with those about it, or with those after it alone, with weights that fall to 37 % over
/// `rows`. About a row they are neither delayed nor advanced.
enum class RowsOfMean { about, after };
std::vector<double> mean_over_rows(const std::vector<double>& values, double rows,
                                   RowsOfMean side = RowsOfMean::about);
void take_noise_away(AxisRecord& record, const InputCorrection& noise);

/// The columns of the roles, on a uniform grid: see EvenGrid. Problems: missing roles or columns, units that
/// differ from the diagram's. `rows_in_one` become one; 0: as many as its length asks for.
AxisRecord read_axis_record(const Experiment& experiment, const Plan& plan, Problems& problems,
                            size_t rows_in_one = 0, const InputCorrection& correction = {});

/// The experiment with the axis cut open at its input: only the measured input drives the diagram.
Experiment cut_open(const Experiment& experiment, const Plan& plan, Problems& problems);

}  // namespace loopwright::diagnosis
