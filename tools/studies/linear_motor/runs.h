/// The linear-motor study: which controllers are tested under which conditions, and their tracking errors.
///
/// The diagrams are those of diagrams/linear_motor; a controller or a condition consists only of changes to
/// them that --set and --variant could also make.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/record/recording.h"

namespace loopwright::paper {

/// The test motion begins after half a second at rest and lasts 2.6 s.
inline constexpr double motion_start_s = 0.5, motion_end_s = 3.1;
/// Limits of its sections since motion_start_s: blend, 0.15 m/s, blend, 0.35 m/s, blend.
inline constexpr double section_borders_s[] = {0, 0.2, 1.2, 1.4, 2.4, 2.6};

struct Controller {
  std::string key;      ///< "ps"
  std::string title;    ///< "PS, as published"
  std::string diagram;  ///< path of the file
  LoadOptions changes;
};

struct Condition {
  std::string key;    ///< "payload2x"
  std::string title;  ///< "Twice the mass"
  LoadOptions changes;
};

/// The paper's motion and stage; another motion on the same stage; and that motion under conditions not
/// covered by the training. The homing error of -1 mm adds to the lag of a late compensation, +1 mm
/// compensates it.
Condition paper_condition();
Condition held_out_condition();
std::vector<Condition> harder_conditions();
/// The paper's motion with the given ratio of payload to nominal mass.
Condition payload_condition(double ratio);

/// Runs one diagram; `run` selects the noise. Throws InputError for an invalid diagram and std::runtime_error
/// for a run that fails.
Recording run_diagram(const std::string& diagram, const LoadOptions& changes, int64_t run);
Recording track(const Controller& controller, const Condition& condition, int64_t run = 0);

/// Mean over runs with different noise, and their standard deviation.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread spread_of(std::span<const double> values);

/// Root mean square of the tracking error measured by the encoder over the motion [m].
double tracking_rmse(const Recording& recording);
Spread tracking_rmse(const Controller& controller, const Condition& condition, int64_t first_run, int runs);

/// The values of a column; throws std::runtime_error if there is none with this name.
std::span<const double> column(const Recording& recording, std::string_view name);

/// Root mean square of the values in rows whose time since motion_start_s lies in [from, to].
double rms_between(const Recording& recording, std::string_view name, double from_s, double to_s);

}  // namespace loopwright::paper
