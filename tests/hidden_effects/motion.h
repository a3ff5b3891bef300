#ifndef HIDDEN_EFFECTS_MOTION_H
#define HIDDEN_EFFECTS_MOTION_H

#include "random.h"

/// The reference motion of a record, in pieces of constant or sinusoidally changing velocity, plus a
/// multisine.
enum { MAX_PIECES = 256, MAX_SINES = 8 };

typedef enum {
  PAPER,
  MANY_SPEEDS,
  CONSTANT_SPEEDS,
  MULTISINE,
  FORWARD,
  HELD_OUT,
  OSCILLATION,
  TRAJECTORIES
} Trajectory;
extern const char* const trajectory_names[TRAJECTORIES];

typedef struct {
  double start_s, duration_s, position_m, from_m_per_s, to_m_per_s;
} Piece;

typedef struct {
  double amplitude_m, frequency_hz, phase_rad;
} Sine;

typedef struct {
  Piece pieces[MAX_PIECES];
  int piece_count;
  Sine sines[MAX_SINES];
  int sine_count;
  double sines_start_s, sines_end_s;  ///< faded in and out over one second
  double stop_s, end_m;
} Motion;

typedef struct {
  double position_m, velocity_m_per_s, acceleration_m_per_s2;
} Wanted;

/// The motion of that name; speeds vary by a few percent with the stream.
Motion motion_make(Trajectory trajectory, Random* random);
Wanted motion_at(const Motion* motion, double time_s);

#endif
