#ifndef HIDDEN_EFFECTS_SCENARIO_H
#define HIDDEN_EFFECTS_SCENARIO_H

#include "controller.h"
#include "effects.h"

enum { MAX_HIDDEN = 3 };

typedef enum { CLEAN, HIDDEN, OUTSIDE, KINDS } Kind;
extern const char* const kind_names[KINDS];

typedef struct {
  double white_n, coloured_n,
      coloured_s;                  ///< force, held over each sample: standard deviations, correlation time
  double encoder_m, resolution_m;  ///< white noise before rounding to counts
} Noise;

/// Everything that a seed determines.
typedef struct {
  uint64_t seed;
  Kind kind;
  Trajectory trajectory;
  ControllerKind controller;
  Motion motion, held_out;
  Noise noise;
  int effect_count;
  Effect effects[MAX_HIDDEN];
  double effect_force_n[MAX_HIDDEN];  ///< rms while moving, beyond that of simpler effects
  Physics stages[MAX_HIDDEN + 1];     ///< nominal, with the first effect, with the first two …
} Scenario;

/// A closed-loop record; columns of `count` samples.
typedef struct {
  int count;
  double *time_s, *reference_m, *feedforward_n, *force_n, *position_m, *true_position_m,
      *true_velocity_m_per_s;
  double *load_velocity_m_per_s, *lagged_n, *delayed_n, *dahl;  ///< the true plant's, at the sample
} Record;

extern const double sample_time_s;

/// Force between samples k and k + 1 that belongs to the effect and that no simpler effect would explain,
/// from the law of motion before and after the effect was added.
double own_force(Effect effect, const Physics* before, const Physics* after, const Record* record, int k);

/// Draws until the loop is stable and every effect leaves a visible trace on the training motion.
Scenario scenario_draw(uint64_t seed);

/// Hides these effects; false if twenty draws of their magnitudes gave no stable loop with a visible trace of
/// each.
bool scenario_hiding(uint64_t seed, Trajectory trajectory, const Effect effects[], int count,
                     Scenario* scenario);

/// The true axis.
const Physics* scenario_truth(const Scenario* scenario);

/// Runs the loop. noise = NULL: no noise at all. The resolution of the encoder is kept unless it is zero.
Record record_make(const Scenario* scenario, const Physics* physics, const Motion* motion, const Noise* noise,
                   double resolution_m, const char* stream, int substeps);
/// Zeros.
Record record_allocate(int count);
void record_free(Record* record);

#endif
