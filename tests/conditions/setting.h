#ifndef CONDITIONS_SETTING_H
#define CONDITIONS_SETTING_H

#include "tests/hidden_effects/scenario.h"

/// The conditions under which a record is made: other machines, rates, clocks, sensors, drives and diagrams
/// than those of the axis benchmark. The laws of motion are those of tests/hidden_effects, computed on an
/// axis of standard size (0.6 m, 0.35 m/s, about 0.6 N): the laws have no scale of their own, so that any
/// other machine is a matter of units.
typedef enum {
  MASS,
  ROTARY,
  RATE,
  JITTER,
  ROUNDED_STAMPS,
  GAPS,
  ORIGIN,
  COLUMN_UNITS,
  VOLTAGE,
  VELOCITY_ONLY,
  COUNTS,
  NO_NOISE,
  LOUD,
  LENGTH,
  KNOWN_NOMINAL,
  WEAK_BESIDE_STRONG,
  LOAD_SIDE,
  GANTRY,
  BETWEEN_SAMPLES,
  FEW_ROWS,
  CONDITIONS
} Condition;
extern const char* const condition_names[CONDITIONS];

/// One standard unit, in SI.
typedef struct {
  double length, time_s, force;
  bool is_rotary;  ///< rad, N·m and kg·m² in place of m, N and kg
} Units;

typedef enum { HELD, LINEAR, BAND_LIMITED, BETWEEN } Between;
extern const char* const between_names[BETWEEN];

/// All lengths, times and forces are standard ones unless they are said to be in SI.
typedef struct {
  Condition condition;
  char variant[40];  ///< what was drawn within the condition
  Units units;
  Trajectory trajectory;
  Motion motion;
  Physics nominal;  ///< what the diagram contains
  double sample_time_s;
  double bandwidth_hz;
  Noise noise;
  bool measures_velocity;
  double velocity_noise, velocity_resolution;
  double jitter;       ///< of the sampling instants, a share of the sample time
  bool only_stamps;    ///< the instants are regular, and the stamps alone jitter
  int stamp_decimals;  ///< of the stamps, which are in SI
  double lost, stale;  ///< shares of the rows: not recorded; the reading of the row before
  bool device_pauses;  ///< the command is held over lost rows; otherwise the loop ran on
  bool repeats_rows;   ///< some rows are there twice, with the same stamp
  double origin_m;
  const char* column;                ///< unit of the recorded motion: "m", "mm", "deg", "rad" or "count"
  bool milliseconds;                 ///< stamps in ms
  double volts_per_force, back_emf;  ///< SI; 0: the command is a force. back_emf is contained in the damping
  Between between;
  double late_s;  ///< a delay of the record by a part of a sample, which counts as an effect; 0: none
  bool flat;      ///< the diagram has no subdiagram
} Setting;

/// Everything except the effects.
Setting setting_draw(Condition condition, Random* random);

/// False for an effect that the plant cannot have in this setting, or that no record of it can show.
bool setting_allows(const Setting* setting, Effect effect);

/// Moves delays, pitches and frequencies to where records of this rate can show them.
void setting_adapt(const Setting* setting, Effect effect, Physics* physics);

/// The law of motion in SI.
Physics physics_in_si(const Physics* physics, const Units* units);
/// [kg or kg·m²] of one standard unit.
double mass_unit(const Units* units);

#endif
