#ifndef HIDDEN_EFFECTS_EFFECTS_H
#define HIDDEN_EFFECTS_EFFECTS_H

#include <stdbool.h>
#include <stdio.h>

#include "motion.h"
#include "plant.h"

/// What can be hidden in a plant: the 23 effects of the catalogue, then some that no catalogue has.
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
/// For an effect outside the catalogue: what it depends on, as JSON.
const char* effect_variables(Effect effect);

/// The wanted motion sampled where it moves, with the force that the nominal model needs: what a magnitude is
/// scaled on.
typedef struct {
  int count;
  double *time_s, *position_m, *velocity_m_per_s, *acceleration_m_per_s2, *force_n;
} Path;

/// Force that the physics consumes beyond what the motor is asked for; without loads, delay, lag and inertia.
double consumed_force(const Physics* physics, double position_m, double velocity_m_per_s, double time_s,
                      double input_n);

/// Not drawn together: they look alike, or are one and the same effect.
bool effects_clash(Effect one, Effect other);

/// Adds the effect to the physics, with parameters from the stream; false if no admissible magnitude was
/// found. Magnitudes are log-uniform: force 5 … 100 % of 0.6 N rms along the path; where a share of force
/// says nothing, see the source.
bool effect_draw(Effect effect, const Path* path, Random* random, Physics* physics);

/// Its parameters as a JSON object.
void effect_write(FILE* file, Effect effect, const Physics* physics);

#endif
