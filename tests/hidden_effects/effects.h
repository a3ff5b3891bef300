#ifndef HIDDEN_EFFECTS_EFFECTS_H
#define HIDDEN_EFFECTS_EFFECTS_H

#include <stdbool.h>
#include <stdio.h>

#include "motion.h"
#include "plant.h"

/// The effects that a plant can hide: the 23 effects of the catalogue, then some outside the catalogue.
typedef enum {
  INERTIA,
  VISCOUS_FRICTION,
  COULOMB_FRICTION,
  STRIBECK_FRICTION,
  DIRECTION_DEPENDENT_FRICTION,
  QUADRATIC_DRAG,
  EDDY_CURRENT_DRAG,
  PRESLIDING_HYSTERESIS,
  COGGING,
  VELOCITY_DEPENDENT_COGGING,
  FORCE_RIPPLE,
  FORCE_GAIN,
  FORCE_SATURATION,
  CONSTANT_FORCE,
  SPRING,
  HARDENING_SPRING,
  END_STOP,
  BACKLASH,
  FLEXIBLE_MODE,
  INPUT_DELAY,
  ACTUATOR_LAG,
  THERMAL_DRIFT,
  ENCODER_PERIODIC_ERROR,
  CATALOGUE,
  POSITION_BUMP = CATALOGUE,
  UNEVEN_FRICTION,
  SINE_IN_TIME,
  UNEVEN_MASS,
  STEP_IN_TIME,
  UNEVEN_DAMPING,
  EFFECTS
} Effect;

extern const char* const effect_names[EFFECTS];
/// For an effect outside the catalogue: the variables on which it depends, as JSON.
const char* effect_variables(Effect effect);

/// The reference motion, sampled while it moves, with the force that the nominal model needs: the scale of
/// magnitudes.
typedef struct {
  int count;
  double *time_s, *position_m, *velocity_m_per_s, *acceleration_m_per_s2, *force_n;
} Path;

/// Slower than this, an axis counts as standing.
static const double moving_m_per_s = 0.002;

/// In equal steps; the caller frees time_s, which holds all arrays.
Path path_of(const Motion* motion, const Physics* nominal, double step_s);

/// Additional force that the physics requires of the motor; without loads, delay, lag and inertia.
double consumed_force(const Physics* physics, double position_m, double velocity_m_per_s, double time_s,
                      double input_n);

/// Not drawn together: they look alike, or are the same effect.
bool effects_clash(Effect one, Effect other);

/// Adds the effect to the physics, with parameters from the stream; false if no admissible magnitude was
/// found. Magnitudes are log-uniform: force 5 … 100 % of 0.6 N rms along the path. For effects to which a
/// share of force does not apply, see the source.
bool effect_draw(Effect effect, const Path* path, Random* random, Physics* physics);

/// Force of the difference between two laws of motion along the path, in units of the scale of magnitudes.
double effect_share(const Path* path, const Physics* before, const Physics* after);

/// Its parameters as a JSON object.
void effect_write(FILE* file, Effect effect, const Physics* physics);

#endif
