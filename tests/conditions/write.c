#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "conditions.h"
#include "tests/hidden_effects/program.h"

static const double degrees = 57.29577951308232, two_pi = 6.283185307179586;

/// [of the column] of one standard unit of length.
static double column_scale(const Setting* s) {
  const double length = s->units.length;
  if (strcmp(s->column, "mm") == 0) return 1000 * length;
  if (strcmp(s->column, "deg") == 0) return degrees * length;
  if (strcmp(s->column, "count") == 0) return 1 / s->noise.resolution_m;
  return length;
}

static double command_scale(const Setting* s) {
  return s->units.force * (s->volts_per_force > 0 ? s->volts_per_force : 1);
}

/// By which the sensor is shifted: whole steps of its resolution.
static double recorded_origin(const Setting* s) {
  const double resolution = s->noise.resolution_m;
  return resolution > 0 ? resolution * round(s->origin_m / resolution) : s->origin_m;
}

/// The recorded motion in the unit of its column. Counts are whole numbers.
static double shown(const Setting* s, const Log* log, int k) {
  const double value = log->truth.position_m[k];
  if (s->measures_velocity) return value * s->units.length / s->units.time_s;
  const double scaled = (value + recorded_origin(s)) * column_scale(s);
  return strcmp(s->column, "count") == 0 ? round(scaled) : scaled;
}

static void write_row(FILE* file, const Setting* s, const Log* log, const Log* second, int k) {
  const double time = log->stamp_s[k] * (s->milliseconds ? 1000 : 1);
  fprintf(file, "%.*f,%.12g,%.*g", s->milliseconds ? s->stamp_decimals - 3 : s->stamp_decimals, time,
          log->truth.force_n[k] * command_scale(s), s->condition == NO_NOISE ? 16 : 12, shown(s, log, k));
  if (second) fprintf(file, ",%.12g,%.12g", second->truth.force_n[k] * s->units.force, shown(s, second, k));
  fputc('\n', file);
}

static bool write_record(const char* folder, const Setting* s, const Log* log, const Log* second) {
  FILE* file = create(folder, "record.csv");
  if (!file) return false;
  fprintf(file, "%s,command,measured%s\n", s->milliseconds ? "t [ms]" : "t",
          second ? ",second_command,second_measured" : "");
  for (int k = 0; k < log->truth.count; ++k) {
    if (log->is_lost[k]) continue;
    write_row(file, s, log, second, k);
    if (log->is_twice[k]) write_row(file, s, log, second, k);
  }
  return done(file);
}

/// What the diagram contains, in SI, over the position as it is recorded.
static void write_machine(FILE* file, const char* key, const Physics* p, double origin) {
  fprintf(file, "  \"%s\": {\"mass\": %.9g, \"damping\": %.9g", key, p->mass_kg - p->load_kg,
          p->damping_n_s_per_m);
  if (p->nominal_cogging.amplitude != 0) {
    const double turns = origin / p->nominal_cogging.pitch_m;
    fprintf(file, ",\n    \"cogging\": {\"pitch\": %.12g, \"amplitude\": %.9g, \"phase\": %.9g}",
            p->nominal_cogging.pitch_m, p->nominal_cogging.amplitude,
            p->nominal_cogging.phase_rad - two_pi * (turns - floor(turns)));
  }
  if (p->offset_n != 0) fprintf(file, ",\n    \"gravity\": %.9g", p->offset_n);
  if (p->stribeck.level_n != 0)
    fprintf(file, ",\n    \"stribeck\": {\"level\": %.9g, \"static_level\": %.9g, \"speed\": %.9g}",
            p->stribeck.level_n, p->stribeck.static_level_n, p->stribeck.speed_m_per_s);
  if (p->load_kg > 0)
    fprintf(file, ",\n    \"%s\": {\"mass\": %.9g, \"stiffness\": %.9g, \"damping\": %.9g}",
            p->motor_at_load ? "motor" : "load", p->load_kg, p->coupling_n_per_m, p->coupling_n_s_per_m);
  fputs("},\n", file);
}

static void write_effects(FILE* file, const Hidden* h, const Physics* si) {
  fputs("  \"effects\": [", file);
  for (int i = 0; i < h->effect_count; ++i) {
    fprintf(file,
            "%s\n    {\"effect\": \"%s\", \"gain\": %.6g, \"counts\": %s, \"parameters\": ", i ? "," : "",
            effect_names[h->effects[i]], h->gains[i], h->gains[i] >= least_gain ? "true" : "false");
    effect_write(file, h->effects[i], si);
    fputc('}', file);
  }
  fputs(h->effect_count ? "\n  ],\n" : "],\n", file);
}

static bool write_truth(const char* folder, const Hidden* h, int rows, const Physics* second) {
  FILE* file = create(folder, "truth.json");
  if (!file) return false;
  const Setting* s = &h->setting;
  const Physics nominal = physics_in_si(&s->nominal, &s->units),
                truth = physics_in_si(&h->stages[h->effect_count], &s->units);
  fprintf(
      file,
      "{\n  \"seed\": %llu,\n  \"condition\": \"%s\",\n  \"variant\": \"%s\",\n  \"trajectory\": \"%s\",\n",
      (unsigned long long)h->seed, condition_names[s->condition], s->variant,
      trajectory_names[s->trajectory]);
  fprintf(file, "  \"rows\": %d,\n  \"sample_time_s\": %.9g,\n  \"duration_s\": %.9g,\n", rows,
          s->sample_time_s * s->units.time_s, s->motion.stop_s * s->units.time_s);
  fprintf(file, "  \"rotary\": %s,\n  \"flat\": %s,\n", s->units.is_rotary ? "true" : "false",
          s->flat ? "true" : "false");
  const double resolution = s->measures_velocity ? s->velocity_resolution * s->units.length / s->units.time_s
                                                 : s->noise.resolution_m * s->units.length;
  fprintf(file,
          "  \"sensor\": {\"quantity\": \"%s\", \"unit\": \"%s\", \"resolution\": %.9g, \"origin\": %.9g},\n",
          s->measures_velocity ? "velocity" : "position", s->column, resolution,
          s->origin_m * s->units.length);
  fprintf(file, "  \"time_unit\": \"%s\",\n  \"interpolation\": \"%s\",\n", s->milliseconds ? "ms" : "s",
          between_names[s->between]);
  if (s->volts_per_force > 0)
    fprintf(file, "  \"motor\": {\"resistance\": %.9g, \"constant\": %.9g},\n",
            s->volts_per_force * s->volts_per_force * s->back_emf, s->volts_per_force * s->back_emf);
  const double origin = recorded_origin(s) * s->units.length;
  write_machine(file, "nominal", &nominal, origin);
  if (second) write_machine(file, "second", second, origin);
  write_effects(file, h, &truth);
  fprintf(file,
          "  \"noise\": {\"white_force\": %.6g, \"slow_force\": %.6g, \"slow_time_s\": %.6g, \"sensor\": "
          "%.6g}\n}\n",
          s->noise.white_n * s->units.force, s->noise.coloured_n * s->units.force,
          s->noise.coloured_s * s->units.time_s,
          s->measures_velocity ? s->velocity_noise * s->units.length / s->units.time_s
                               : s->noise.encoder_m * s->units.length);
  return done(file);
}

/// The other axis of a gantry: lighter, another motion, nothing hidden.
static Log second_axis(const Hidden* h, bool quiet, Physics* physics) {
  Random random = random_stream(h->seed, "second motion");
  Setting second = h->setting;
  second.nominal.mass_kg *= 0.6;
  second.nominal.nominal_cogging.amplitude = 0;
  *physics = second.nominal;
  const Motion motion = motion_make(MANY_SPEEDS, &random);
  return log_make(&second, physics, &motion, h->seed, "second record", quiet);
}

bool hidden_write(const Hidden* h, const char* folder, bool quiet) {
  if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
    fprintf(stderr, "%s: %s\n", folder, strerror(errno));
    return false;
  }
  const Setting* s = &h->setting;
  Log log = log_make(s, &h->stages[h->effect_count], &s->motion, h->seed, "record", quiet), second;
  Physics other;
  const bool has_second = s->condition == GANTRY;
  if (has_second) second = second_axis(h, quiet, &other);
  const Physics other_in_si = has_second ? physics_in_si(&other, &s->units) : (Physics){0};
  const bool good = write_record(folder, s, &log, has_second ? &second : NULL) &&
                    write_truth(folder, h, log.truth.count, has_second ? &other_in_si : NULL);
  if (has_second) log_free(&second);
  log_free(&log);
  return good;
}
