#ifndef CONDITIONS_SIMULATE_H
#define CONDITIONS_SIMULATE_H

#include "setting.h"

/// A record in closed loop. The columns of `truth` are those of the axis benchmark: the instants of its rows
/// are the true ones, and position_m is the reading of the sensor, position or velocity.
typedef struct {
  Record truth;
  double* stamp_s;  ///< SI, before rounding
  bool *is_lost, *is_twice;
} Log;

/// quiet: without noise and counts, for tests.
Log log_make(const Setting* setting, const Physics* physics, const Motion* motion, uint64_t seed,
             const char* stream, bool quiet);
void log_free(Log* log);

/// Whether the loop kept to its motion, without ringing.
bool log_is_sound(const Setting* setting, const Log* log);

#endif
