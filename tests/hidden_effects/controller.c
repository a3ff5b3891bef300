#include "controller.h"

#include <math.h>

#include "hw/emulator/elementary.h"

const char* const controller_names[CONTROLLERS] = {"pd_with_observer", "cascade"};

static const double two_pi = 6.283185307179586;

double filter_step(Filter* filter, double input) {
  const double output = filter->numerator[0] * input + filter->state[0];
  for (int i = 0; i < FILTER_ORDER; ++i) {
    const double later = i + 1 < FILTER_ORDER ? filter->state[i + 1] : 0;
    filter->state[i] = later + filter->numerator[i + 1] * input - filter->denominator[i + 1] * output;
  }
  return output;
}

/// Kp + Kd (1 − 1/z)/T behind a first-order low-pass.
static Filter pd_filter(double proportional, double derivative, double low_pass_hz, double sample_time_s) {
  const double pole = exponential_of(-two_pi * low_pass_hz * sample_time_s),
               slope = derivative * (1 - pole) / sample_time_s;
  return (Filter){.numerator = {proportional + slope, -proportional * pole - slope},
                  .denominator = {1, -pole}};
}

/// (1 − q)²/(1 − q/z)² times b0 + b1/z + b2/z².
static Filter behind_low_pass(double frequency_hz, double sample_time_s, double b0, double b1, double b2) {
  const double q = exponential_of(-two_pi * frequency_hz * sample_time_s), gain = (1 - q) * (1 - q);
  return (Filter){.numerator = {gain * b0, gain * b1, gain * b2}, .denominator = {1, -2 * q, q * q}};
}

Controller controller_make(ControllerKind kind, double mass, double damping, double T) {
  Controller controller = {.kind = kind};
  const double bandwidth = two_pi * 18, observer_hz = 10;
  controller.feedback = pd_filter(mass * bandwidth * bandwidth, 1.6 * bandwidth * mass - damping, 150, T);
  controller.observer_position = behind_low_pass(observer_hz, T, mass / (T * T) + damping / T,
                                                 -2 * mass / (T * T) - damping / T, mass / (T * T));
  controller.observer_command = behind_low_pass(observer_hz, T, 0.5, 0.5, 0);
  controller.position_gain_per_s = 40;
  controller.velocity_gain_n_s_per_m = 160 * mass - damping;
  controller.velocity = (Filter){.numerator = {1 / T, -1 / T}, .denominator = {1}};
  return controller;
}

Controller controller_pd(double mass, double damping, double T, double bandwidth_hz, double low_pass_hz) {
  const double bandwidth = two_pi * bandwidth_hz;
  const double derivative = fmax(1.6 * bandwidth * mass - damping, 0);
  return (Controller){.kind = PD_WITH_OBSERVER,
                      .feedback = pd_filter(mass * bandwidth * bandwidth, derivative, low_pass_hz, T)};
}

double controller_step(Controller* c, double reference, double feedforward, double measured) {
  if (c->kind == CASCADE) {
    const double wanted_velocity = c->position_gain_per_s * (reference - measured);
    return c->velocity_gain_n_s_per_m * (wanted_velocity - filter_step(&c->velocity, measured));
  }
  const double disturbance =
      filter_step(&c->observer_position, measured) - filter_step(&c->observer_command, c->previous_command_n);
  c->previous_command_n = filter_step(&c->feedback, reference - measured) + feedforward - disturbance;
  return c->previous_command_n;
}
