#include "information.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hw/emulator/elementary.h"

/// Carriage and load, and the slow force.
enum { X, V, LOAD_X, LOAD_V, SLOW, ORDER, COLUMNS = 2 * MAX_HIDDEN };

typedef double Matrix[ORDER][ORDER];

typedef struct {
  Matrix transition;
  double input[ORDER];           ///< of a force on the carriage held over a sample
  double noise_input[ORDER];     ///< of the force noise: at the motor
  double gain[ORDER], variance;  ///< of the steady Kalman filter
  int measured;                  ///< X or V
} Model;

static void multiply(Matrix a, Matrix b, Matrix result) {
  for (int i = 0; i < ORDER; ++i)
    for (int j = 0; j < ORDER; ++j) {
      result[i][j] = 0;
      for (int k = 0; k < ORDER; ++k) result[i][j] += a[i][k] * b[k][j];
    }
}

/// ∂(slopes)/∂(states), and by a force on the carriage and at the motor.
static void slopes(const Physics* p, bool has_load, Matrix a, double carriage[ORDER], double motor[ORDER]) {
  memset(a, 0, sizeof(Matrix));
  memset(carriage, 0, ORDER * sizeof *carriage), memset(motor, 0, ORDER * sizeof *motor);
  const double load = has_load ? p->load_kg : 0, mass = p->mass_kg + p->added_mass_kg - load;
  const double k = has_load ? p->coupling_n_per_m : 0, d = has_load ? p->coupling_n_s_per_m : 0;
  const double damping = p->damping_n_s_per_m + p->added_damping_n_s_per_m;
  a[X][V] = 1;
  a[V][X] = -(p->spring_n_per_m + k) / mass, a[V][V] = -(damping + d) / mass;
  carriage[V] = 1 / mass;
  if (has_load) {
    a[V][LOAD_X] = k / mass, a[V][LOAD_V] = d / mass;
    a[LOAD_X][LOAD_V] = 1;
    a[LOAD_V][X] = k / load, a[LOAD_V][V] = d / load, a[LOAD_V][LOAD_X] = -k / load,
    a[LOAD_V][LOAD_V] = -d / load;
  }
  motor[p->motor_at_load ? LOAD_V : V] = p->motor_at_load ? 1 / load : 1 / mass;
  for (int i = 0; i < ORDER; ++i) a[i][SLOW] = motor[i];
}

/// Taylor series of exp(a h) and of its integral over a part of the sample, and doubling.
static void sample_model(Matrix a, double time_s, const double carriage[ORDER], const double motor[ORDER],
                         Model* m) {
  enum { DOUBLINGS = 12, TERMS = 10 };
  const double h = time_s / (1 << DOUBLINGS);
  Matrix whole = {{0}}, integral = {{0}}, term = {{0}}, next;
  for (int i = 0; i < ORDER; ++i) term[i][i] = 1;
  for (int n = 0; n < TERMS; ++n) {  // term = (a h)^n/n!
    for (int i = 0; i < ORDER; ++i)
      for (int j = 0; j < ORDER; ++j) whole[i][j] += term[i][j], integral[i][j] += term[i][j] * h / (n + 1);
    multiply(a, term, next);
    for (int i = 0; i < ORDER; ++i)
      for (int j = 0; j < ORDER; ++j) term[i][j] = next[i][j] * h / (n + 1);
  }
  for (int n = 0; n < DOUBLINGS; ++n) {
    multiply(whole, integral, next);
    for (int i = 0; i < ORDER; ++i)
      for (int j = 0; j < ORDER; ++j) integral[i][j] += next[i][j];
    multiply(whole, whole, next);
    memcpy(whole, next, sizeof next);
  }
  memcpy(m->transition, whole, sizeof whole);
  for (int i = 0; i < ORDER; ++i) {
    m->input[i] = m->noise_input[i] = 0;
    for (int j = 0; j < ORDER; ++j)
      m->input[i] += integral[i][j] * carriage[j], m->noise_input[i] += integral[i][j] * motor[j];
  }
}

/// The Riccati equation, iterated until its gain is steady.
static void steady_filter(const Setting* s, double noise_n, double measurement_variance, Model* m) {
  const double memory = exponential_of(-s->sample_time_s / s->noise.coloured_s);
  m->transition[SLOW][SLOW] = memory;
  const double slow_variance = (1 - memory * memory) * s->noise.coloured_n * s->noise.coloured_n;
  Matrix p = {{0}}, corrected, transposed, next;
  for (int i = 0; i < ORDER; ++i)
    for (int j = 0; j < ORDER; ++j) transposed[i][j] = m->transition[j][i];
  const int c = m->measured;
  for (int iteration = 0; iteration < 50000; ++iteration) {
    m->variance = p[c][c] + measurement_variance;
    double change = 0;
    for (int i = 0; i < ORDER; ++i) {
      const double gain = p[i][c] / m->variance;
      if (iteration > 0 && i < SLOW) change = fmax(change, fabs(gain - m->gain[i]) - 1e-9 * fabs(gain));
      m->gain[i] = gain;
    }
    if (iteration > 100 && change <= 0) break;
    for (int i = 0; i < ORDER; ++i)
      for (int j = 0; j < ORDER; ++j) corrected[i][j] = p[i][j] - m->gain[i] * p[c][j];
    multiply(m->transition, corrected, next);
    multiply(next, transposed, p);
    for (int i = 0; i < ORDER; ++i)
      for (int j = 0; j < ORDER; ++j) p[i][j] += noise_n * noise_n * m->noise_input[i] * m->noise_input[j];
    p[SLOW][SLOW] += slow_variance;
  }
}

/// Without noise a billionth of the stroke and a millionth of the force stand for it.
static Model model_of(const Setting* s, const Physics* truth) {
  const double least_n = 6e-7, least_m = 6e-10, least_m_per_s = 3e-9;
  Model model = {.measured = s->measures_velocity ? V : X};
  Matrix a;
  double carriage[ORDER], motor[ORDER];
  slopes(truth, s->nominal.load_kg > 0, a, carriage, motor);
  sample_model(a, s->sample_time_s, carriage, motor, &model);
  const double noise = s->measures_velocity ? s->velocity_noise : s->noise.encoder_m,
               count = s->measures_velocity ? s->velocity_resolution : s->noise.resolution_m,
               least = s->measures_velocity ? least_m_per_s : least_m;
  steady_filter(s, fmax(s->noise.white_n, least_n), noise * noise + count * count / 12 + least * least,
                &model);
  return model;
}

static double mean_force(Effect effect, const Physics* before, const Physics* after, const Record* r, int k) {
  if (fabs(r->true_velocity_m_per_s[k]) < moving_m_per_s ||
      fabs(r->true_velocity_m_per_s[k + 1]) < moving_m_per_s)
    return 0;
  const double early = own_force(effect, before, after, r, k);
  return k + 2 < r->count ? 0.5 * (early + own_force(effect, before, after, r, k + 1)) : early;
}

typedef struct {
  double state[ORDER];
} Response;

/// One whitened prediction error; `shift` is an error of the sensor itself.
static double respond(const Model* m, Response* response, double force, double shift) {
  double* d = response->state;
  const double error = d[m->measured] + shift;
  double corrected[ORDER];
  for (int i = 0; i < ORDER; ++i) corrected[i] = d[i] - m->gain[i] * error;
  for (int i = 0; i < ORDER; ++i) {
    d[i] = m->input[i] * force;
    for (int j = 0; j < ORDER; ++j) d[i] += m->transition[i][j] * corrected[j];
  }
  return error / sqrt(m->variance);
}

static bool is_dry(Effect effect) { return effect == STRIBECK_FRICTION || effect == PRESLIDING_HYSTERESIS; }

/// What is left of column i beside all others: 1/(G⁻¹)_ii by elimination of the others.
static double left_beside_others(double g[COLUMNS][COLUMNS], int columns, int i) {
  double m[COLUMNS][COLUMNS];
  memcpy(m, g, sizeof m);
  for (int pivot = 0; pivot < columns; ++pivot) {
    if (pivot == i || m[pivot][pivot] <= 1e-10 * g[pivot][pivot]) continue;
    for (int row = 0; row < columns; ++row) {
      if (row == pivot) continue;
      const double factor = m[row][pivot] / m[pivot][pivot];
      for (int column = 0; column < columns; ++column)
        if (column != pivot) m[row][column] -= factor * m[pivot][column];
      m[row][pivot] = 0;
    }
  }
  return fmax(m[i][i], 0);
}

void information(const Setting* s, const Physics stages[], const Effect effects[], int count, const Log* log,
                 double gains[]) {
  const Physics* truth = &stages[count];
  const Model model = model_of(s, truth);
  const Record* r = &log->truth;
  Response responses[COLUMNS] = {{{0}}};
  double gram[COLUMNS][COLUMNS] = {{0}}, errors[COLUMNS];
  int columns = count;
  for (int k = 0; k + 1 < r->count; ++k) {
    columns = count;
    for (int i = 0; i < count; ++i) {
      const bool is_sensor = effects[i] == ENCODER_PERIODIC_ERROR;
      const double force = is_sensor ? 0 : mean_force(effects[i], &stages[i], &stages[i + 1], r, k),
                   shift = is_sensor ? periodic(truth->encoder, r->true_position_m[k]) : 0;
      errors[i] = respond(&model, &responses[i], force, shift);
    }
    for (int i = 0; i < count; ++i)
      if (is_dry(effects[i])) {  // the level of dry friction is free beside its own shape
        const double v = r->true_velocity_m_per_s[k];
        errors[columns] = respond(&model, &responses[columns], v > 0.002 ? 1 : v < -0.002 ? -1 : 0, 0);
        ++columns;
      }
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < columns; ++j) gram[i][j] += errors[i] * errors[j];
  }
  for (int i = 0; i < count; ++i) gains[i] = left_beside_others(gram, columns, i);
}
