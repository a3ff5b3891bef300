#include "effects.h"

#include <math.h>

static const double two_pi = 6.283185307179586, force_scale_n = 0.6, pole_pitch_m = 0.0225;

/// The parameter that scales the effect's force; none if the magnitude is drawn in its own units.
static double* magnitude(Effect effect, Physics* p) {
  switch (effect) {
    case VISCOUS_FRICTION:
      return &p->added_damping_n_s_per_m;
    case COULOMB_FRICTION:
      return &p->coulomb_n;
    case STRIBECK_FRICTION:
      return &p->stribeck.level_n;
    case DIRECTION_DEPENDENT_FRICTION:
      return &p->direction_damping_n_s_per_m;
    case QUADRATIC_DRAG:
      return &p->quadratic_n_s2_per_m2;
    case EDDY_CURRENT_DRAG:
      return &p->eddy_n_s_per_m;
    case COGGING:
      return &p->cogging.amplitude;
    case VELOCITY_DEPENDENT_COGGING:
      return &p->moving_cogging.amplitude;
    case FORCE_RIPPLE:
      return &p->ripple.amplitude;
    case FORCE_GAIN:
      return &p->gain;
    case FORCE_SATURATION:
      return &p->saturation_per_n;
    case CONSTANT_FORCE:
      return &p->offset_n;
    case SPRING:
      return &p->spring_n_per_m;
    case HARDENING_SPRING:
      return &p->cubic_n_per_m3;
    case END_STOP:
      return &p->stop_n_per_m;
    case THERMAL_DRIFT:
      return &p->drift;
    case POSITION_BUMP:
      return &p->bump_n;
    case UNEVEN_FRICTION:
      return &p->uneven_n;
    case SINE_IN_TIME:
      return &p->hum_n;
    case STEP_IN_TIME:
      return &p->step_n;
    case UNEVEN_DAMPING:
      return &p->coupled_n_s_per_m2;
    default:
      return NULL;
  }
}

/// A pitch that fits at least five times into the stroke, different from the line of the nominal model.
static double free_pitch(const Physics* p, Random* random) {
  double pitch;
  do pitch = random_log_uniform(random, 0.005, 0.08);
  while (p->nominal_cogging.amplitude != 0 && fabs(1 / pitch - 1 / p->nominal_cogging.pitch_m) < 4);
  return pitch;
}

static Periodic periodic_draw(double amplitude, double pitch_m, Random* random) {
  return (Periodic){amplitude, pitch_m, random_uniform(random, 0, two_pi)};
}

/// All parameters except the magnitude.
static void draw_shape(Effect effect, double duration_s, Random* random, Physics* p) {
  switch (effect) {
    case STRIBECK_FRICTION:
      p->stribeck =
          (Stribeck){0, 0, random_log_uniform(random, 0.004, 0.08), random_below(random, 4) ? 2 : 1};
      break;
    case EDDY_CURRENT_DRAG:
      p->eddy_speed_m_per_s = random_log_uniform(random, 0.05, 0.25);
      break;
    case COGGING: {
      const bool harmonic = random_below(random, 2) == 0;
      const int order = 1 + random_below(random, 4);
      const double pitch = harmonic && (order > 1 || p->nominal_cogging.amplitude == 0)
                               ? pole_pitch_m / order
                               : free_pitch(p, random);
      p->cogging = periodic_draw(0, pitch, random);
      break;
    }
    case VELOCITY_DEPENDENT_COGGING:
      p->moving_cogging = periodic_draw(0, pole_pitch_m, random);
      break;
    case FORCE_RIPPLE:
      p->ripple = periodic_draw(0, pole_pitch_m / (1 + random_below(random, 2)), random);
      break;
    case SPRING:
      p->spring_rest_m = random_uniform(random, 0, 0.6);
      break;
    case HARDENING_SPRING:
      p->cubic_rest_m = random_uniform(random, 0.1, 0.5);
      break;
    case END_STOP:
      p->stop_m = random_uniform(random, 0.35, 0.55);
      break;
    case THERMAL_DRIFT:
      p->drift_of = (DriftOf)random_below(random, DRIFTS);
      p->drift_time_s = duration_s * random_log_uniform(random, 0.3, 1);
      break;
    case POSITION_BUMP:
      p->bump_m = random_uniform(random, 0.15, 0.45);
      p->bump_width_m = random_log_uniform(random, 0.01, 0.04);
      break;
    case UNEVEN_FRICTION:
      p->uneven_m = 0.6;
      break;
    case SINE_IN_TIME:
      p->hum_hz = random_log_uniform(random, 0.4, 30);
      p->hum_rad = random_uniform(random, 0, two_pi);
      break;
    case STEP_IN_TIME:
      p->step_s = duration_s * random_uniform(random, 0.3, 0.7);
      break;
    case UNEVEN_DAMPING:
      p->coupled_rest_m = 0.3;
      break;
    default:
      break;
  }
}

static double rms_consumed(const Path* path, const Physics* before, const Physics* after) {
  double sum = 0;
  for (int i = 0; i < path->count; ++i) {
    const double x = path->position_m[i], v = path->velocity_m_per_s[i], t = path->time_s[i],
                 u = path->force_n[i];
    const double difference = consumed_force(after, x, v, t, u) - consumed_force(before, x, v, t, u);
    sum += difference * difference;
  }
  return sqrt(sum / path->count);
}

double effect_share(const Path* path, const Physics* before, const Physics* after) {
  return rms_consumed(path, before, after) / force_scale_n;
}

static double rms(const double* values, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += values[i] * values[i];
  return sqrt(sum / count);
}

static double peak(const double* values, int count) {
  double most = 0;
  for (int i = 0; i < count; ++i) most = fmax(most, fabs(values[i]));
  return most;
}

static bool either_sign(Effect effect) {
  switch (effect) {
    case DIRECTION_DEPENDENT_FRICTION:
    case CONSTANT_FORCE:
    case FORCE_GAIN:
    case THERMAL_DRIFT:
    case VISCOUS_FRICTION:
    case POSITION_BUMP:
    case STEP_IN_TIME:
      return true;
    default:
      return false;
  }
}

/// Limits of a real axis: no negative damping or mass, no motor that inverts its force.
static bool admissible(Effect effect, const Path* path, const Physics* p) {
  const double damping = p->damping_n_s_per_m;
  switch (effect) {
    case VISCOUS_FRICTION:
      return p->added_damping_n_s_per_m > -0.7 * damping;
    case DIRECTION_DEPENDENT_FRICTION:
      return fabs(p->direction_damping_n_s_per_m) < 0.9 * damping;
    case FORCE_GAIN:
      return fabs(p->gain) < 0.4;
    case FORCE_RIPPLE:
      return p->ripple.amplitude < 0.6;
    case FORCE_SATURATION:
      return p->saturation_per_n * peak(path->force_n, path->count) < 0.35;
    case THERMAL_DRIFT:
      return fabs(p->drift) < (p->drift_of == DRIFT_OF_FORCE_CONSTANT ? 0.5
                               : p->drift_of == DRIFT_OF_DAMPING      ? 0.7 * damping
                                                                      : 1.0);
    case UNEVEN_DAMPING:
      return p->coupled_n_s_per_m2 * 0.3 < damping;
    default:
      return true;
  }
}

/// A payload as a share of force, but at most twice the mass; sometimes less mass than assumed.
static bool draw_mass(Effect effect, const Path* path, double share, Random* random, Physics* p) {
  const double needed_kg = share * force_scale_n / rms(path->acceleration_m_per_s2, path->count);
  if (effect == UNEVEN_MASS) {
    p->uneven_mass_kg_per_m = needed_kg / 0.35;
    return needed_kg < 2 * p->mass_kg;
  }
  const bool lighter = random_below(random, 5) == 0;
  p->added_mass_kg = lighter ? -needed_kg : needed_kg;
  return needed_kg < (lighter ? 0.4 : 2) * p->mass_kg;
}

/// A load of 20 … 50 % of the mass; the total is unchanged.
static void draw_load(Effect effect, Random* random, Physics* p) {
  const double backlash_hz = 60;
  p->load_kg = p->mass_kg * random_uniform(random, 0.2, 0.5);
  const bool gap = effect == BACKLASH;
  const double frequency = two_pi * (gap ? backlash_hz : random_log_uniform(random, 8, 35));
  const double damping_ratio = gap ? 0.2 : random_log_uniform(random, 0.01, 0.1);
  p->gap_m = gap ? random_log_uniform(random, 0.0001, 0.001) : -1;
  p->load_damping_n_s_per_m = gap ? p->damping_n_s_per_m * p->load_kg / p->mass_kg : 0;
  p->coupling_n_per_m = p->load_kg * frequency * frequency;
  p->coupling_n_s_per_m = 2 * damping_ratio * frequency * p->load_kg;
}

/// One trial; false if the magnitude is not admissible.
static bool draw_once(Effect effect, const Path* path, Random* random, Physics* p) {
  const double share = random_log_uniform(random, effect < CATALOGUE ? 0.05 : 0.15, 1);
  switch (effect) {
    case INERTIA:
    case UNEVEN_MASS:
      return draw_mass(effect, path, share, random, p);
    case BACKLASH:
    case FLEXIBLE_MODE:
      draw_load(effect, random, p);
      return true;
    case INPUT_DELAY:
      p->delay_s = random_log_uniform(random, 0.0007, 0.005);
      return true;
    case ACTUATOR_LAG:
      p->lag_s = random_log_uniform(random, 0.001, 0.006);
      return true;
    case PRESLIDING_HYSTERESIS:
      p->dahl_n = share * force_scale_n;
      p->dahl_distance_m = random_log_uniform(random, 0.00025, 0.01);
      return true;
    case ENCODER_PERIODIC_ERROR:
      p->encoder =
          periodic_draw(random_log_uniform(random, 1e-6, 8e-6), random_uniform(random, 0.003, 0.012), random);
      return true;
    default:
      break;
  }
  const Physics before = *p;
  const double sign = either_sign(effect) ? random_sign(random) : 1, ratio = random_uniform(random, 1.4, 2.5);
  draw_shape(effect, path->time_s[path->count - 1], random, p);
  double* scale = magnitude(effect, p);
  *scale = 1e-3;  // small, because the laws of the motor multiply each other
  if (effect == STRIBECK_FRICTION) p->stribeck.static_level_n = ratio * *scale;
  *scale *= share * force_scale_n / rms_consumed(path, &before, p);
  if (effect == STRIBECK_FRICTION) p->stribeck.static_level_n = ratio * *scale;
  *scale *= sign;
  return admissible(effect, path, p);
}

bool effect_draw(Effect effect, const Path* path, Random* random, Physics* physics) {
  const Physics before = *physics;
  for (int attempt = 0; attempt < 20; ++attempt) {
    *physics = before;
    if (draw_once(effect, path, random, physics)) return true;
  }
  *physics = before;
  return false;
}
