#include "plant.h"

#include <math.h>
#include <string.h>

#include "hw/emulator/elementary.h"

static const double two_pi = 6.283185307179586;

static double square(double x) { return x * x; }

double periodic(Periodic term, double x) {
  return term.amplitude == 0 ? 0 : term.amplitude * sine_of(two_pi * x / term.pitch_m + term.phase_rad);
}

static double drifted(const Physics* p, DriftOf what, double t) {
  return p->drift == 0 || p->drift_of != what ? 0 : p->drift * (1 - exponential_of(-t / p->drift_time_s));
}

double plant_motor_force(const Physics* p, double f, double x, double t) {
  const double saturated = f * (1 - p->saturation_per_n * fabs(f));
  return saturated * (1 + p->gain) * (1 + periodic(p->ripple, x)) *
         (1 + drifted(p, DRIFT_OF_FORCE_CONSTANT, t));
}

double plant_resisting_force(const Physics* p, double x, double v, double t) {
  double force = (p->damping_n_s_per_m + p->added_damping_n_s_per_m - p->load_damping_n_s_per_m) * v;
  force +=
      periodic(p->nominal_cogging, x) + periodic(p->cogging, x) + fabs(v) * periodic(p->moving_cogging, x);
  force += p->direction_damping_n_s_per_m * fabs(v) + p->quadratic_n_s2_per_m2 * v * fabs(v) + p->offset_n;
  if (p->eddy_n_s_per_m != 0) force += p->eddy_n_s_per_m * v / (1 + square(v / p->eddy_speed_m_per_s));
  force += p->spring_n_per_m * (x - p->spring_rest_m) +
           p->cubic_n_per_m3 * square(x - p->cubic_rest_m) * (x - p->cubic_rest_m);
  if (p->stop_n_per_m != 0) force += p->stop_n_per_m * fmax(0, x - p->stop_m);
  force += drifted(p, DRIFT_OF_DAMPING, t) * v + drifted(p, DRIFT_OF_OFFSET, t);
  if (p->bump_n != 0) force += p->bump_n * exponential_of(-0.5 * square((x - p->bump_m) / p->bump_width_m));
  if (p->hum_n != 0) force += p->hum_n * sine_of(two_pi * p->hum_hz * t + p->hum_rad);
  if (p->step_n != 0 && t >= p->step_s) force += p->step_n;
  return force + p->coupled_n_s_per_m2 * (x - p->coupled_rest_m) * v;
}

double plant_dry_friction(const Physics* p, double speed, double x) {
  double level = p->coulomb_n;
  if (p->uneven_n != 0) level += p->uneven_n * fmax(0, x / p->uneven_m);
  const Stribeck* s = &p->stribeck;
  if (s->level_n != 0)
    level += s->level_n + (s->static_level_n - s->level_n) *
                              exponential_of(-power_of(speed / s->speed_m_per_s, s->exponent));
  return level;
}

/// Elastic contact with damping (Kelvin and Voigt) that pushes but does not pull.
static double contact(const Physics* p, double indentation, double speed) {
  if (indentation <= 0) return 0;
  return fmax(0, p->coupling_n_per_m * indentation + p->coupling_n_s_per_m * speed);
}

double plant_coupling_force(const Physics* p, const double s[STATES]) {
  if (p->load_kg == 0) return 0;
  const double stretch = s[POSITION] - s[LOAD_POSITION], speed = s[VELOCITY] - s[LOAD_VELOCITY];
  if (p->gap_m < 0) return p->coupling_n_per_m * stretch + p->coupling_n_s_per_m * speed;
  return contact(p, stretch - 0.5 * p->gap_m, speed) - contact(p, -stretch - 0.5 * p->gap_m, -speed);
}

double plant_carriage_mass(const Physics* p, double x) {
  return p->mass_kg + p->added_mass_kg - p->load_kg + p->uneven_mass_kg_per_m * x;
}

static double drive(const Physics* p, const double s[STATES], double t, double input, double noise) {
  const double lagged = p->lag_s > 0 ? s[LAG] : input;
  return plant_motor_force(p, lagged, s[POSITION], t) + noise;
}

/// All forces on the carriage except dry friction.
static double applied_force(const Physics* p, const double s[STATES], double t, double input, double noise) {
  double force = p->motor_at_load ? 0 : drive(p, s, t, input, noise);
  force -= plant_resisting_force(p, s[POSITION], s[VELOCITY], t) + p->dahl_n * s[DAHL];
  return force - plant_coupling_force(p, s);
}

typedef struct {
  double input_n, noise_n;
} Held;

static void slope(const Plant* plant, const double s[STATES], double t, Held held, double ds[STATES]) {
  const Physics* p = plant->physics;
  const double v = s[VELOCITY];
  memset(ds, 0, STATES * sizeof *ds);
  if (plant->direction != 0) {
    const double dry = plant->direction * plant_dry_friction(p, fabs(v), s[POSITION]);
    ds[POSITION] = v;
    ds[VELOCITY] =
        (applied_force(p, s, t, held.input_n, held.noise_n) - dry) / plant_carriage_mass(p, s[POSITION]);
  }
  if (p->lag_s > 0) ds[LAG] = (held.input_n - s[LAG]) / p->lag_s;
  if (p->dahl_n != 0) ds[DAHL] = (v - fabs(v) * s[DAHL]) / p->dahl_distance_m;
  if (p->load_kg > 0) {
    const double speed = s[LOAD_VELOCITY];
    const double drag =
        p->load_damping_n_s_per_m * speed + p->load_friction_n * speed / sqrt(speed * speed + 2.5e-7);
    ds[LOAD_POSITION] = s[LOAD_VELOCITY];
    const double push = p->motor_at_load ? drive(p, s, t, held.input_n, held.noise_n) : 0;
    ds[LOAD_VELOCITY] = (plant_coupling_force(p, s) - drag + push) / p->load_kg;
  }
}

/// The classical Runge-Kutta method.
static void runge_kutta(const Plant* plant, double h, Held held, double result[STATES]) {
  const double *s = plant->state, t = plant->time_s;
  double k1[STATES], k2[STATES], k3[STATES], k4[STATES], at[STATES];
  slope(plant, s, t, held, k1);
  for (int i = 0; i < STATES; ++i) at[i] = s[i] + 0.5 * h * k1[i];
  slope(plant, at, t + 0.5 * h, held, k2);
  for (int i = 0; i < STATES; ++i) at[i] = s[i] + 0.5 * h * k2[i];
  slope(plant, at, t + 0.5 * h, held, k3);
  for (int i = 0; i < STATES; ++i) at[i] = s[i] + h * k3[i];
  slope(plant, at, t + h, held, k4);
  for (int i = 0; i < STATES; ++i) result[i] = s[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

/// Not negative until an event: the carriage reverses or breaks away, a contact opens or closes.
enum { REVERSAL, HIGH_STOP, ONSET, FORWARD_GAP, BACKWARD_GAP, FORWARD_PUSH, BACKWARD_PUSH, WATCHES };

static void watch(const Plant* plant, const double s[STATES], double t, Held held, double watched[WATCHES]) {
  const Physics* p = plant->physics;
  memset(watched, 0, WATCHES * sizeof *watched);
  if (plant->direction != 0)
    watched[REVERSAL] = plant->direction * s[VELOCITY];
  else
    watched[REVERSAL] =
        plant_dry_friction(p, 0, s[POSITION]) - fabs(applied_force(p, s, t, held.input_n, held.noise_n));
  if (p->stop_n_per_m != 0) watched[HIGH_STOP] = s[POSITION] - p->stop_m;
  if (p->step_n != 0) watched[ONSET] = t - p->step_s;
  if (p->load_kg > 0 && p->gap_m >= 0) {
    const double stretch = s[POSITION] - s[LOAD_POSITION], speed = s[VELOCITY] - s[LOAD_VELOCITY];
    const double k = p->coupling_n_per_m, d = p->coupling_n_s_per_m, half = 0.5 * p->gap_m;
    watched[FORWARD_GAP] = stretch - half;
    watched[BACKWARD_GAP] = -stretch - half;
    watched[FORWARD_PUSH] = stretch > half ? k * (stretch - half) + d * speed : -1;
    watched[BACKWARD_PUSH] = -stretch > half ? k * (-stretch - half) - d * speed : -1;
  }
}

static bool differs(const double before[WATCHES], const double after[WATCHES]) {
  for (int i = 0; i < WATCHES; ++i)
    if ((before[i] >= 0) != (after[i] >= 0)) return true;
  return false;
}

/// At rest: held by dry friction, or released in the direction of the force.
static void settle_direction(Plant* plant, Held held) {
  const double force = applied_force(plant->physics, plant->state, plant->time_s, held.input_n, held.noise_n);
  const double dry = plant_dry_friction(plant->physics, 0, plant->state[POSITION]);
  plant->direction = fabs(force) <= dry ? 0 : force > 0 ? 1 : -1;
}

/// One step of at most h, shorter if an event occurs inside, but at least least_s; returns its length.
static double step(Plant* plant, double h, double least_s, Held held) {
  double before[WATCHES], after[WATCHES], reached[STATES];
  if (plant->direction == 0) settle_direction(plant, held);
  watch(plant, plant->state, plant->time_s, held, before);
  runge_kutta(plant, h, held, reached);
  watch(plant, reached, plant->time_s + h, held, after);
  const bool happened = differs(before, after) && h > least_s;
  if (happened) {
    double early = 0, late = h;
    while (late - early > 1e-13) {
      const double middle = 0.5 * (early + late);
      runge_kutta(plant, middle, held, reached);
      watch(plant, reached, plant->time_s + middle, held, after);
      *(differs(before, after) ? &late : &early) = middle;
    }
    h = fmax(late, least_s);  // no endless loop if an event follows itself
    runge_kutta(plant, h, held, reached);
    watch(plant, reached, plant->time_s + h, held, after);
  }
  memcpy(plant->state, reached, sizeof reached);
  plant->time_s += h;
  if (happened && before[REVERSAL] >= 0 && after[REVERSAL] < 0) {
    plant->state[VELOCITY] = 0;
    settle_direction(plant, held);
  }
  return h;
}

/// Steps between two commands after which events chatter, as at a slide that just begins.
enum { OFTEN = 2000 };

static void advance(Plant* plant, double duration_s, Held held) {
  if (duration_s <= 0) return;
  const int steps = (int)ceil(plant->substeps * duration_s / plant->sample_time_s);
  const double whole = duration_s / steps;
  for (int i = 0, taken = 0; i < steps; ++i)
    for (double left = whole; left > 1e-15; ++taken)
      left -= step(plant, left, taken < OFTEN ? 1e-9 : fmin(left, whole / 50), held);
}

void plant_advance(Plant* plant, double duration_s, double input_n, double noise_n) {
  advance(plant, duration_s, (Held){input_n, noise_n});
}

Plant plant_at_rest(const Physics* physics, double sample_time_s, int substeps) {
  Plant plant = {.physics = physics, .sample_time_s = sample_time_s, .substeps = substeps};
  return plant;
}

/// The delay in whole samples and the remainder.
static int whole_samples(const Plant* plant, double* rest_s) {
  const int whole = (int)floor(plant->physics->delay_s / plant->sample_time_s);
  *rest_s = plant->physics->delay_s - whole * plant->sample_time_s;
  return whole;
}

void plant_sample(Plant* plant, double input_n, double noise_n) {
  memmove(plant->input + 1, plant->input, (DELAY_SAMPLES - 1) * sizeof *plant->input);
  plant->input[0] = input_n;
  double rest_s;
  const int whole = whole_samples(plant, &rest_s);
  advance(plant, rest_s, (Held){plant->input[whole + 1], noise_n});
  advance(plant, plant->sample_time_s - rest_s, (Held){plant->input[whole], noise_n});
}

double plant_encoder(const Plant* plant) {
  const double x = plant->state[POSITION];
  return x + periodic(plant->physics->encoder, x);
}

double plant_delayed_input(const Plant* plant) {
  double rest_s;
  const int whole = whole_samples(plant, &rest_s);
  const double share = rest_s / plant->sample_time_s;
  return share * plant->input[whole + 1] + (1 - share) * plant->input[whole];
}
