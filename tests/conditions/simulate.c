#include "simulate.h"

#include <math.h>
#include <stdlib.h>

#include "hw/emulator/elementary.h"

enum { QUEUE = 4096, PARTS = 8 };

/// A command under way to the motor.
typedef struct {
  double arrival_s, value_n;
} Command;

typedef struct {
  Plant plant;
  Command queue[QUEUE];
  unsigned first, count;
  double acting_n;             ///< the command at the motor
  double acted_n_s, sent_n_s;  ///< integrals since the row, at the motor and as if there were no delay
} Drive;

static void send(Drive* drive, double time_s, double value_n) {
  if (drive->count == QUEUE) abort();
  drive->queue[(drive->first + drive->count++) % QUEUE] =
      (Command){time_s + drive->plant.physics->delay_s, value_n};
}

static void push(Drive* drive, double duration_s, double noise_n) {
  if (duration_s <= 0) return;
  plant_advance(&drive->plant, duration_s, drive->acting_n, noise_n);
  drive->acted_n_s += duration_s * drive->acting_n;
}

/// Up to this time, with the commands that arrive until then.
static void drive_until(Drive* drive, double time_s, double noise_n) {
  double now = drive->plant.time_s;
  while (drive->count > 0 && drive->queue[drive->first].arrival_s <= time_s) {
    const Command command = drive->queue[drive->first];
    push(drive, command.arrival_s - now, noise_n);
    now = fmax(now, command.arrival_s);
    drive->acting_n = command.value_n;
    drive->first = (drive->first + 1) % QUEUE;
    --drive->count;
  }
  push(drive, time_s - now, noise_n);
  drive->plant.time_s = time_s;  // the sum of the parts differs by rounding
}

/// A loop that is faster than the record: its command, through a low-pass, is smooth between rows.
typedef struct {
  Controller controller;
  Filter smooth;
  double before_n;  ///< its last command
} Loop;

static double reference_force(const Setting* s, const Wanted* wanted) {
  const Physics* p = &s->nominal;
  const double v = wanted->velocity_m_per_s, dry = plant_dry_friction(p, fabs(v), 0);
  const double direction = fabs(v) < 0.005 ? v / 0.005 : v > 0 ? 1 : -1;
  return p->mass_kg * wanted->acceleration_m_per_s2 + p->damping_n_s_per_m * v + p->offset_n +
         direction * dry;
}

static double next_command(Loop* loop, const Setting* s, const Motion* motion, double time_s,
                           double measured_m) {
  const Wanted wanted = motion_at(motion, time_s);
  return controller_step(&loop->controller, wanted.position_m, reference_force(s, &wanted), measured_m);
}

static Loop loop_make(const Setting* s) {
  const double parts = s->between == BAND_LIMITED ? PARTS : 1, tick_s = s->sample_time_s / parts;
  const double bandwidth = s->between == HELD ? s->bandwidth_hz : 0.5 * s->bandwidth_hz;
  const double q = exponential_of(-6.283185307179586 * 0.06 / parts), gain = (1 - q) * (1 - q);
  return (Loop){
      controller_pd(s->nominal.mass_kg, s->nominal.damping_n_s_per_m, tick_s, bandwidth, 8 * bandwidth),
      (Filter){.numerator = {gain}, .denominator = {1, -2 * q, q * q}}, 0};
}

/// Sends what acts from row to row; returns what the record shows at this row.
static double row_command(Loop* loop, Drive* drive, const Setting* s, const Motion* motion, double time_s,
                          double measured_m, double noise_n) {
  const double before = loop->before_n, part_s = s->sample_time_s / PARTS;
  if (s->between == BAND_LIMITED) {
    double shown = 0;
    for (int i = 0; i < PARTS; ++i) {
      const double now = time_s + i * part_s;
      if (i > 0) drive_until(drive, now, noise_n);
      const double command =
          filter_step(&loop->smooth, next_command(loop, s, motion, now, drive->plant.state[POSITION]));
      if (i == 0) shown = 0.5 * (loop->before_n + command);  // held over parts: at the row it is on the way
      send(drive, now, command);
      drive->sent_n_s += part_s * command;
      loop->before_n = command;
    }
    return shown;
  }
  loop->before_n = next_command(loop, s, motion, time_s, measured_m);
  if (s->between == HELD) {
    send(drive, time_s, loop->before_n);
    drive->sent_n_s = s->sample_time_s * loop->before_n;
    return loop->before_n;
  }
  for (int i = 0; i < PARTS; ++i)
    send(drive, time_s + i * part_s, before + (i + 0.5) / PARTS * (loop->before_n - before));
  drive->sent_n_s = 0.5 * s->sample_time_s * (before + loop->before_n);
  return before;
}

static double counted(double value, double resolution) {
  return resolution > 0 ? resolution * round(value / resolution) : value;
}

static double reading(const Setting* s, const Plant* plant, Random* random, bool quiet) {
  const double noise = quiet ? 0 : random_normal(random);
  if (s->measures_velocity)
    return counted(plant->state[VELOCITY] + s->velocity_noise * noise, quiet ? 0 : s->velocity_resolution);
  return counted(plant_encoder(plant) + s->noise.encoder_m * noise, quiet ? 0 : s->noise.resolution_m);
}

/// Marks the rows that are not there: single ones, and runs of up to twenty.
static void draw_lost(Log* log, double share, Random* random) {
  const int rows = log->truth.count;
  for (int k = 3; k < rows - 3; ++k) {
    if (random_unit(random) >= share / 3) continue;
    int length = random_below(random, 5) == 0 ? 2 + random_below(random, 19) : 1;
    for (; length > 0 && k < rows - 3; --length) log->is_lost[k++] = true;
  }
}

static Log log_allocate(int rows) {
  Log log = {record_allocate(rows), calloc((size_t)rows, sizeof(double)), calloc((size_t)rows, sizeof(bool)),
             calloc((size_t)rows, sizeof(bool))};
  if (!log.stamp_s || !log.is_lost || !log.is_twice) abort();
  return log;
}

void log_free(Log* log) {
  record_free(&log->truth);
  free(log->stamp_s), free(log->is_lost), free(log->is_twice);
}

static void draw_rows(const Setting* s, Log* log, Random* random) {
  for (int k = 0; k < log->truth.count; ++k) {
    const double regular = k * s->sample_time_s,
                 moved = k == 0 ? regular
                                : regular + s->jitter * s->sample_time_s * random_uniform(random, -1, 1);
    log->truth.time_s[k] = s->only_stamps ? regular : moved;
    log->stamp_s[k] = moved * s->units.time_s;
    if (s->repeats_rows) log->is_twice[k] = k > 3 && random_unit(random) < 0.001;
  }
  if (s->lost > 0) draw_lost(log, s->lost, random);
}

static void keep_state(Record* r, int k, const Plant* plant) {
  r->true_position_m[k] = plant->state[POSITION];
  r->true_velocity_m_per_s[k] = plant->state[VELOCITY];
  r->load_velocity_m_per_s[k] = plant->state[LOAD_VELOCITY];
  r->lagged_n[k] = plant->state[LAG];
  r->dahl[k] = plant->state[DAHL];
}

Log log_make(const Setting* s, const Physics* physics, const Motion* motion, uint64_t seed,
             const char* stream, bool quiet) {
  const double finest_s = fmax(1e-4, s->sample_time_s / 40);
  Log log = log_allocate((int)(s->motion.stop_s / s->sample_time_s) + 1);
  Record* r = &log.truth;
  Random random = random_stream(seed, stream);
  draw_rows(s, &log, &random);
  Drive* drive = calloc(1, sizeof *drive);
  if (!drive) abort();
  drive->plant = plant_at_rest(physics, s->sample_time_s, (int)fmax(2, ceil(s->sample_time_s / finest_s)));
  Loop loop = loop_make(s);
  const Noise* noise = &s->noise;
  const double memory = exponential_of(-s->sample_time_s / noise->coloured_s);
  double coloured = quiet ? 0 : noise->coloured_n * random_normal(&random), force_noise = 0;
  for (int k = 0; k < r->count; ++k) {
    if (k > 0) {
      drive_until(drive, r->time_s[k], force_noise);
      r->delayed_n[k - 1] = r->force_n[k - 1] - (drive->sent_n_s - drive->acted_n_s) / s->sample_time_s;
      drive->sent_n_s = drive->acted_n_s = 0;
    }
    keep_state(r, k, &drive->plant);
    const bool is_stale = s->stale > 0 && k > 3 && random_unit(&random) < s->stale;
    r->position_m[k] = is_stale ? r->position_m[k - 1] : reading(s, &drive->plant, &random, quiet);
    force_noise = quiet ? 0 : noise->white_n * random_normal(&random) + coloured;
    // The drive of a motor with a velocity sensor in the record controls by an encoder of its own.
    const double measured = s->measures_velocity ? drive->plant.state[POSITION] : r->position_m[k];
    r->force_n[k] = log.is_lost[k] && s->device_pauses
                        ? drive->acting_n
                        : row_command(&loop, drive, s, motion, r->time_s[k], measured, force_noise);
    if (!quiet)
      coloured = memory * coloured + sqrt(1 - memory * memory) * noise->coloured_n * random_normal(&random);
  }
  free(drive);
  return log;
}

bool log_is_sound(const Setting* s, const Log* log) {
  const double farthest_m = 0.15, largest = 5;
  const Record* r = &log->truth;
  double force = 0, expected = 0;
  for (int k = 0; k < r->count; ++k) {
    const Wanted wanted = motion_at(&s->motion, r->time_s[k]);
    if (!(fabs(r->true_position_m[k] - wanted.position_m) < farthest_m)) return false;
    const double needed = reference_force(s, &wanted);
    force += r->force_n[k] * r->force_n[k], expected += needed * needed + 0.36;
  }
  return force < largest * largest * expected;
}
