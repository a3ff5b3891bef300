#include "scenario.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hw/emulator/elementary.h"

const char* const kind_names[KINDS] = {"clean", "hidden", "outside"};
const double sample_time_s = 0.001;

enum { SUBSTEPS = 10 };

const Physics* scenario_truth(const Scenario* scenario) { return &scenario->stages[scenario->effect_count]; }

// ---- Records

Record record_allocate(int count) {
  Record record = {.count = count};
  double** columns[] = {
      &record.time_s,     &record.reference_m,           &record.feedforward_n, &record.force_n,
      &record.position_m, &record.true_position_m,       &record.lagged_n,      &record.true_velocity_m_per_s,
      &record.delayed_n,  &record.load_velocity_m_per_s, &record.dahl};
  const int columns_count = sizeof columns / sizeof *columns;
  double* all = calloc((size_t)count * columns_count, sizeof *all);
  if (!all) abort();
  for (int i = 0; i < columns_count; ++i) *columns[i] = all + (size_t)i * count;
  return record;
}

void record_free(Record* record) { free(record->time_s); }

static double rounded(double value, double resolution) {
  return resolution > 0 ? resolution * round(value / resolution) : value;
}

Record record_make(const Scenario* scenario, const Physics* physics, const Motion* motion, const Noise* noise,
                   double resolution_m, const char* stream, int substeps) {
  const Physics* nominal = &scenario->stages[0];
  Record record = record_allocate((int)(motion->stop_s / sample_time_s) + 1);
  Plant plant = plant_at_rest(physics, sample_time_s, substeps);
  Controller controller =
      controller_make(scenario->controller, nominal->mass_kg, nominal->damping_n_s_per_m, sample_time_s);
  Random random = random_stream(scenario->seed, stream);
  double coloured = noise ? noise->coloured_n * random_normal(&random) : 0;
  for (int k = 0; k < record.count; ++k) {
    record.time_s[k] = k * sample_time_s;
    const Wanted wanted = motion_at(motion, record.time_s[k]);
    record.reference_m[k] = wanted.position_m;
    record.feedforward_n[k] = nominal->mass_kg * wanted.acceleration_m_per_s2 +
                              nominal->damping_n_s_per_m * wanted.velocity_m_per_s;
    record.true_position_m[k] = plant.state[POSITION];
    record.true_velocity_m_per_s[k] = plant.state[VELOCITY];
    record.load_velocity_m_per_s[k] = plant.state[LOAD_VELOCITY];
    record.lagged_n[k] = plant.state[LAG];
    record.dahl[k] = plant.state[DAHL];
    const double seen = plant_encoder(&plant) + (noise ? noise->encoder_m * random_normal(&random) : 0);
    record.position_m[k] = rounded(seen, resolution_m);
    record.force_n[k] =
        controller_step(&controller, record.reference_m[k], record.feedforward_n[k], record.position_m[k]);
    const double white = noise ? noise->white_n * random_normal(&random) : 0;
    plant_sample(&plant, record.force_n[k], white + coloured);
    record.delayed_n[k] = plant_delayed_input(&plant);
    if (noise) {
      const double memory = exponential_of(-sample_time_s / noise->coloured_s);
      coloured = memory * coloured + sqrt(1 - memory * memory) * noise->coloured_n * random_normal(&random);
    }
  }
  return record;
}

// ---- The trace of an effect in a record

double own_force(Effect effect, const Physics* before, const Physics* after, const Record* r, int k) {
  const double x = r->true_position_m[k], v = r->true_velocity_m_per_s[k], t = r->time_s[k];
  const double interval_s = r->time_s[k + 1] - t,
               acceleration = (r->true_velocity_m_per_s[k + 1] - v) / interval_s;
  switch (effect) {
    case INERTIA:
      return after->added_mass_kg * acceleration;
    case UNEVEN_MASS:
      return after->uneven_mass_kg_per_m * x * acceleration;
    case INPUT_DELAY:
      return r->force_n[k] - r->delayed_n[k];
    case ACTUATOR_LAG:
      return r->delayed_n[k] - 0.5 * (r->lagged_n[k] + r->lagged_n[k + 1]);
    case PRESLIDING_HYSTERESIS:
      return after->dahl_n * (r->dahl[k] - (v > 0 ? 1 : -1));
    case STRIBECK_FRICTION:
      return plant_dry_friction(after, fabs(v), x) - after->stribeck.level_n;
    case BACKLASH:
    case FLEXIBLE_MODE: {
      const double load = (r->load_velocity_m_per_s[k + 1] - r->load_velocity_m_per_s[k]) / interval_s;
      return after->load_kg * (load - acceleration);
    }
    case ENCODER_PERIODIC_ERROR: {
      if (k == 0) return 0;
      double error[3];
      for (int i = 0; i < 3; ++i) error[i] = periodic(after->encoder, r->true_position_m[k - 1 + i]);
      return after->mass_kg * (error[2] - 2 * error[1] + error[0]) / (interval_s * interval_s);
    }
    default:
      return consumed_force(after, x, v, t, r->force_n[k]) - consumed_force(before, x, v, t, r->force_n[k]);
  }
}

static double own_force_rms(Effect effect, const Physics* before, const Physics* after,
                            const Record* record) {
  double sum = 0;
  int count = 0;
  for (int k = 0; k + 1 < record->count; ++k) {
    if (fabs(record->true_velocity_m_per_s[k]) < moving_m_per_s) continue;
    const double force = own_force(effect, before, after, record, k);
    sum += force * force;
    ++count;
  }
  return count ? sqrt(sum / count) : 0;
}

// ---- Drawing

static bool in_control(const Record* record) {
  for (int k = 0; k < record->count; ++k)
    if (!(fabs(record->position_m[k] - record->reference_m[k]) < 0.05)) return false;
  return true;
}

/// Noise must not make the loop ring: no real axis is operated in this way.
static bool well_damped(const Record* with_noise, const Record* without) {
  double sum = 0;
  for (int k = 0; k < without->count; ++k) {
    const double apart = with_noise->true_position_m[k] - without->true_position_m[k];
    sum += apart * apart;
  }
  return sqrt(sum / without->count) < 1e-4;
}

static bool visible(Scenario* scenario, const Record* record) {
  const double least_n = 0.006;  // 1 % of the force while moving
  bool all = true;
  for (int i = 0; i < scenario->effect_count; ++i) {
    scenario->effect_force_n[i] =
        own_force_rms(scenario->effects[i], &scenario->stages[i], &scenario->stages[i + 1], record);
    all = all && scenario->effect_force_n[i] >= least_n;
  }
  return all;
}

static bool runs_well(const Scenario* scenario, const Motion* motion, const Record* without_noise) {
  const Noise* noise = &scenario->noise;
  Record record =
      record_make(scenario, scenario_truth(scenario), motion, noise, noise->resolution_m, "trial", SUBSTEPS);
  const bool good = in_control(&record) && well_damped(&record, without_noise);
  record_free(&record);
  return good;
}

static bool worth_asking(Scenario* scenario) {
  const Motion* motions[] = {&scenario->motion, &scenario->held_out};
  bool good = true;
  for (int i = 0; i < 2 && good; ++i) {
    Record record = record_make(scenario, scenario_truth(scenario), motions[i], NULL, 0, "none", SUBSTEPS);
    good = in_control(&record) && (i > 0 || visible(scenario, &record)) &&
           runs_well(scenario, motions[i], &record);
    record_free(&record);
  }
  return good;
}

static void draw_names(Scenario* scenario, int wanted, Random* random) {
  scenario->effect_count = 0;
  while (scenario->effect_count < wanted) {
    const bool last = scenario->effect_count + 1 == wanted;
    const Effect effect = scenario->kind == OUTSIDE && last
                              ? CATALOGUE + random_below(random, EFFECTS - CATALOGUE)
                              : random_below(random, CATALOGUE);
    bool clash = false;
    for (int i = 0; i < scenario->effect_count; ++i)
      clash = clash || effects_clash(effect, scenario->effects[i]);
    if (!clash) scenario->effects[scenario->effect_count++] = effect;
  }
}

static bool draw_magnitudes(Scenario* scenario, const Path* path, Random* random) {
  for (int i = 0; i < scenario->effect_count; ++i) {
    scenario->stages[i + 1] = scenario->stages[i];
    if (!effect_draw(scenario->effects[i], path, random, &scenario->stages[i + 1])) return false;
  }
  return true;
}

static Noise draw_noise(Random* random) {
  static const double resolutions_m[] = {1e-7, 2e-7, 2e-7, 5e-7};
  const double level = random_log_uniform(random, 0.7, 1.4);
  return (Noise){0.01 * level, 0.003 * level, 0.03, 5e-8, resolutions_m[random_below(random, 4)]};
}

/// Everything except the effects.
static void draw_setting(Scenario* scenario, Random* random) {
  scenario->controller = random_below(random, 4) ? PD_WITH_OBSERVER : CASCADE;
  scenario->motion = motion_make(scenario->trajectory, random);
  scenario->held_out = motion_make(HELD_OUT, random);
  scenario->noise = draw_noise(random);
  Physics* nominal = &scenario->stages[0];
  nominal->mass_kg = 0.2621;
  nominal->damping_n_s_per_m = 3;
  if (random_below(random, 2))
    nominal->nominal_cogging = (Periodic){0.15, 0.0225, random_uniform(random, 0, 6.28)};
}

Scenario scenario_draw(uint64_t seed) {
  static const int kinds_of_20[] = {CLEAN, CLEAN, CLEAN, CLEAN, OUTSIDE, OUTSIDE};
  static const Trajectory trajectories_of_20[] = {
      PAPER,       PAPER,           PAPER,           PAPER,           PAPER,
      PAPER,       MANY_SPEEDS,     MANY_SPEEDS,     MANY_SPEEDS,     MANY_SPEEDS,
      MANY_SPEEDS, CONSTANT_SPEEDS, CONSTANT_SPEEDS, CONSTANT_SPEEDS, CONSTANT_SPEEDS,
      MULTISINE,   MULTISINE,       MULTISINE,       FORWARD,         FORWARD};
  Random random = random_stream(seed, "scenario");
  const int kind = random_below(&random, 20);
  Scenario scenario = {.seed = seed, .kind = kind < 6 ? (Kind)kinds_of_20[kind] : HIDDEN};
  scenario.trajectory = trajectories_of_20[random_below(&random, 20)];
  draw_setting(&scenario, &random);
  const int wanted = scenario.kind == CLEAN ? 0 : 1 + random_below(&random, scenario.kind == HIDDEN ? 3 : 2);
  Path path = path_of(&scenario.motion, &scenario.stages[0], sample_time_s);
  bool found = false;
  while (!found) {
    draw_names(&scenario, wanted, &random);
    for (int attempt = 0; attempt < 20 && !found; ++attempt)
      found = draw_magnitudes(&scenario, &path, &random) && worth_asking(&scenario);
  }
  free(path.time_s);
  return scenario;
}

bool scenario_hiding(uint64_t seed, Trajectory trajectory, const Effect effects[], int count,
                     Scenario* scenario) {
  Random random = random_stream(seed, "scenario");
  *scenario = (Scenario){.seed = seed, .kind = count ? HIDDEN : CLEAN, .trajectory = trajectory};
  draw_setting(scenario, &random);
  scenario->effect_count = count;
  for (int i = 0; i < count; ++i) {
    scenario->effects[i] = effects[i];
    if (effects[i] >= CATALOGUE) scenario->kind = OUTSIDE;
  }
  Path path = path_of(&scenario->motion, &scenario->stages[0], sample_time_s);
  bool found = false;
  for (int attempt = 0; attempt < 20 && !found; ++attempt)
    found = draw_magnitudes(scenario, &path, &random) && worth_asking(scenario);
  free(path.time_s);
  return found;
}
