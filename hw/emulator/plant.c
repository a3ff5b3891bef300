#include "plant.h"

#include <math.h>
#include <string.h>

#include "elementary.h"

static const double pi = 3.14159265358979323846;
static const double gravity = 9.80665;
static const double longest_step = 20e-6;

void plant_reset(struct plant* p) {
  memset(p, 0, sizeof *p);
  p->amplifier_gain = 1, p->current_limit = 10, p->current_lag = 0.4e-3, p->force_constant = 1;
  p->mass = 0.2621, p->load_at = 1e9;
  p->damping = 2.4, p->drag = 0.3;
  p->coulomb = 0, p->transition_speed = 0.05;
  p->stribeck_speed = 0.01;
  p->pole_pitch = 0.0225;
  p->cogging[0] = 0.76, p->cogging_phase[0] = 0.4;
  p->cogging[1] = 0.152, p->cogging_phase[1] = 0.5;
  p->cogging_slope = 0.6;
  p->cogging_modulation = 0.08, p->modulation_period = 0.36;
  p->stop_low = -0.05, p->stop_high = 0.75, p->restitution = 0.3;
}

static double clamp(double x, double limit) { return x > limit ? limit : x < -limit ? -limit : x; }

/* Constants during one call: the series is A sin(n x + phase) = a sin(n x) + b cos(n x). */
struct series {
  double sine[PLANT_HARMONICS], cosine[PLANT_HARMONICS];
  int harmonics;
  double sine_of_tilt;
  double current_share; /* fraction of the way to its command that the current covers in a step */
};

static struct series series_of(const struct plant* p, double h) {
  struct series s = {.current_share = p->current_lag > 0 ? 1 - exponential_of(-h / p->current_lag) : 1,
                     .sine_of_tilt = sine_of(p->tilt)};
  for (int n = 0; n < PLANT_HARMONICS; ++n) {
    s.sine[n] = p->cogging[n] * cosine_of(p->cogging_phase[n]), s.cosine[n] = p->cogging[n] * sine_of(p->cogging_phase[n]);
    if (p->cogging[n] != 0) s.harmonics = n + 1;
  }
  return s;
}

static double cogging(const struct plant* p, const struct series* s) {
  if (s->harmonics == 0) return 0;
  const double angle = 2 * pi * p->position / p->pole_pitch;
  double sine, cosine;
  sine_and_cosine_of(angle, &sine, &cosine);
  double along = 1; /* its sine is computed while the processor waits for the others */
  if (p->cogging_modulation != 0)
    along += p->cogging_modulation * sine_of(2 * pi * p->position / p->modulation_period);
  double sum = 0, sine_n = sine, cosine_n = cosine;
  for (int n = 0; n < s->harmonics; ++n) {
    sum += s->sine[n] * sine_n + s->cosine[n] * cosine_n;
    const double next = sine_n * cosine + cosine_n * sine;
    cosine_n = cosine_n * cosine - sine_n * sine, sine_n = next;
  }
  const double by_speed = 1 - p->cogging_slope * fabs(p->velocity);
  return (by_speed > 0 ? by_speed : 0) * along * sum;
}

static double friction(const struct plant* p) {
  const double v = p->velocity;
  double force = p->damping * v + p->drag * v * fabs(v);
  double level = p->coulomb + (v < 0 ? p->coulomb_backward : 0);
  if (p->stribeck != 0) level += p->stribeck * exponential_of(-(v / p->stribeck_speed) * (v / p->stribeck_speed));
  if (level != 0) force += level * hyperbolic_tangent_of(v / p->transition_speed);
  return force;
}

static void step(struct plant* p, const struct series* s, double command, double now, double h) {
  p->current += (command - p->current) * s->current_share;
  const double mass = p->mass + p->payload + (now >= p->load_at ? p->load_change : 0);
  const double force = p->force_constant * p->current - friction(p) - cogging(p, s) - p->offset -
                       p->cable * (p->position - p->cable_center) - (p->tilt != 0 ? mass * gravity * s->sine_of_tilt : 0);
  p->velocity += h * force / mass;
  p->position += h * p->velocity;
  if (p->position > p->stop_high && p->velocity > 0) p->position = p->stop_high, p->velocity *= -p->restitution;
  if (p->position < p->stop_low && p->velocity < 0) p->position = p->stop_low, p->velocity *= -p->restitution;
}

void plant_advance(struct plant* p, double volts, double now, double seconds) {
  const double command = clamp(p->amplifier_gain * volts, p->current_limit);
  const int steps = (int)ceil(seconds / longest_step - 1e-9);
  if (steps == 0) return;
  const double h = seconds / steps;
  const struct series s = series_of(p, h);
  for (int i = 0; i < steps; ++i) step(p, &s, command, now + i * h, h);
}
