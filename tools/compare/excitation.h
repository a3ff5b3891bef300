/// What a record contains, hence which effects can be identified from it, and its faults.
#pragma once
#include "tools/compare/missing_force.h"
#include "tools/effects/effect.h"

namespace loopwright {

struct RecordContent {
  RecordSizes sizes;
  int directions = 0;     ///< 1 or 2 that take at least a twentieth of the moving time
  int speeds = 0;         ///< speeds that differ by a fifth and together last a tenth of a second
  int accelerations = 0;  ///< 2: acceleration and deceleration well above the noise
  int reversals = 0;
  int passes = 1;             ///< number of times that the same motion is made
  bool varied_force = false;  ///< different forces at the same positions
};

RecordContent content_of(const Machine& machine, const ForceResidual& residual, double resolution);

/// Whether an effect can be identified from a record, or what is missing for it.
struct Identifiability {
  std::string effect;
  bool can_be_found = true;
  std::string lacks;  ///< in words: "motion in both directions (there is one)"
};
std::vector<Identifiability> identifiable(const RecordContent& content, const std::vector<Effect>& catalogue);

/// How often the axis moves the other way than before; flickering at rest does not count.
int reversals_in(const MeasuredMotion& motion);

/// A fault of the record, with its consequence.
struct RecordFault {
  std::string name;  ///< too_short, one_direction, one_speed, unsynchronised, wrong_sign, wrong_unit, gaps,
                     ///< outliers, saturated
  std::string text;  ///< what was observed
  std::string cost;  ///< what is unreliable because of it
  bool is_fatal = false;        ///< no effect can be named from such a record
  bool may_be_physics = false;  ///< unless effects explain all of it: then it was no fault
};
std::vector<RecordFault> faults_of(const Machine& machine, const ForceResidual& residual,
                                   const RecordContent& content);

/// One of several records of a machine.
struct RecordView {
  const MeasuredMotion& motion;
  const ForceResidual& residual;
  const RecordContent& content;
};
/// What the records contain together.
RecordContent content_of(const std::vector<RecordView>& records);
/// Directions, speeds, duration and the limit of the input are those of all records together: a motion that
/// goes one way is no fault if another record goes the other way. Further faults are named with their record.
std::vector<RecordFault> faults_of(const std::vector<RecordView>& records);

}  // namespace loopwright
