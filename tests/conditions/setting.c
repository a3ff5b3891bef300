#include "setting.h"

#include <math.h>
#include <stdio.h>

static const double two_pi = 6.283185307179586, stroke_m = 0.6, top_speed_m_per_s = 0.35;

const char* const condition_names[CONDITIONS] = {"mass",
                                                 "rotary",
                                                 "rate",
                                                 "jitter",
                                                 "rounded_stamps",
                                                 "gaps",
                                                 "origin",
                                                 "column_units",
                                                 "voltage",
                                                 "velocity_only",
                                                 "counts",
                                                 "no_noise",
                                                 "loud",
                                                 "length",
                                                 "known_nominal",
                                                 "weak_beside_strong",
                                                 "load_side",
                                                 "gantry",
                                                 "between_samples",
                                                 "few_rows_between_turns"};
const char* const between_names[BETWEEN] = {"hold", "linear", "band_limited"};

static void name_variant(Setting* s, const char* text) {
  snprintf(s->variant, sizeof s->variant, "%s", text);
}

/// Every condition begins with this machine: 0.2 … 5 kg, 0.2 … 1.2 m, 0.5 … 2 kHz, one motion of 6 … 80 s.
static void draw_base(Setting* s, double mass_kg, double stroke, Random* random) {
  static const double rates_hz[] = {500, 1000, 1000, 1000, 2000};
  static const Trajectory trajectories[] = {PAPER, PAPER, PAPER, MANY_SPEEDS, MULTISINE};
  static const double resolutions_m[] = {1e-7, 2e-7, 5e-7};
  s->nominal.mass_kg = 0.2621 * random_log_uniform(random, 0.6, 1.7);
  s->nominal.damping_n_s_per_m = 3 * random_log_uniform(random, 0.4, 1.4);
  s->trajectory = trajectories[random_below(random, 5)];
  const double longest = s->trajectory == PAPER ? 1.5 : s->trajectory == MULTISINE ? 1.1 : 0.9;
  s->units.time_s = random_log_uniform(random, 0.5, longest);
  s->units.length = stroke / stroke_m;
  s->units.force = mass_kg / s->nominal.mass_kg * s->units.length / (s->units.time_s * s->units.time_s);
  s->sample_time_s = 1 / (rates_hz[random_below(random, 5)] * s->units.time_s);
  const double level = random_log_uniform(random, 0.7, 1.4);
  s->noise = (Noise){0.01 * level, 0.003 * level, 0.03, 5e-8, resolutions_m[random_below(random, 3)]};
  if (random_below(random, 4) == 0)
    s->nominal.nominal_cogging = (Periodic){0.15, 0.0225, random_uniform(random, 0, two_pi)};
  s->flat = random_below(random, 3) == 0;
}

/// A shaft: the inertia in kg·m², the turns of its stroke, a sensor of 2^17 … 2^20 counts a turn. As
/// everywhere here, no expression draws twice: C leaves the order open.
static void make_rotary(Setting* s, double least_inertia, double least_turns, double most_turns,
                        Random* random) {
  const double turns = random_uniform(random, least_turns, most_turns);
  const double inertia = random_log_uniform(random, least_inertia, 1e-2);
  s->units.is_rotary = true;
  s->column = "rad";
  s->units.length = two_pi * turns / stroke_m;
  s->units.force = inertia / s->nominal.mass_kg * s->units.length / (s->units.time_s * s->units.time_s);
  s->noise.resolution_m = two_pi / (double)(1 << (17 + random_below(random, 4))) / s->units.length;
  s->noise.encoder_m = 0.3 * s->noise.resolution_m;
  if (s->nominal.nominal_cogging.amplitude != 0)  // a whole number of periods a turn
    s->nominal.nominal_cogging.pitch_m =
        two_pi / s->units.length / round(two_pi / (0.0225 * s->units.length));
}

/// For the same machine.
static void set_time_unit(Setting* s, double time_s) {
  const double faster = s->units.time_s / time_s;
  s->units.force *= faster * faster;
  s->units.time_s = time_s;
}

static void draw_stamps(Setting* s, Random* random) {
  static const double rates_hz[] = {750, 1024, 51200};
  const int which = random_below(random, 3);
  snprintf(s->variant, sizeof s->variant, "1/%g s", rates_hz[which]);
  if (which == 2) s->trajectory = PAPER, set_time_unit(s, 0.3);
  s->sample_time_s = 1 / (rates_hz[which] * s->units.time_s);
  s->stamp_decimals = which == 2 ? 6 + random_below(random, 2) : 4 + random_below(random, 3);
}

static void draw_gaps(Setting* s, Random* random) {
  static const char* const names[] = {"lost by the log", "missed by the device", "stale readings",
                                      "rows there twice"};
  const int which = random_below(random, 4);
  name_variant(s, names[which]);
  const double share = random_log_uniform(random, 0.001, 0.02);
  if (which <= 1) s->lost = share;
  s->device_pauses = which == 1;
  if (which == 2) s->stale = share;
  s->repeats_rows = which == 3;
}

static void draw_units(Setting* s, Random* random) {
  static const char* const columns[] = {"mm", "count", "deg"};
  const int which = random_below(random, 3);
  if (which == 2) make_rotary(s, 1e-4, 1, 8, random);
  s->column = columns[which];
  s->milliseconds = random_below(random, 2) == 0;
  snprintf(s->variant, sizeof s->variant, "%s%s", s->column, s->milliseconds ? ", ms" : "");
}

/// Half of the damping is the motor's: K²/R.
static void draw_voltage(Setting* s) {
  const Physics si = physics_in_si(&s->nominal, &s->units);
  s->back_emf = 0.5 * si.damping_n_s_per_m;
  const double resistance = 1.7, constant = sqrt(s->back_emf * resistance);
  s->volts_per_force = resistance / constant;
}

static void draw_counts(Setting* s, Random* random) {
  const double counts = round(random_log_uniform(random, 1000, 20000));
  make_rotary(s, 1e-4, 2, 20, random);
  s->noise.resolution_m = two_pi / counts / s->units.length;
  s->noise.encoder_m = random_uniform(random, 0.05, 0.3) * s->noise.resolution_m;
  snprintf(s->variant, sizeof s->variant, counts < 4000 ? "1000 to 4000 a turn" : "4000 to 20000 a turn");
}

static void draw_no_noise(Setting* s, Random* random) {
  const bool exact = random_below(random, 2) == 0;
  name_variant(s, exact ? "exact" : "counts of 1e-8 of the stroke");
  s->noise = (Noise){0, 0, 0.03, 0, exact ? 0 : 1e-8 * stroke_m};
}

enum { SLOW_RATES = 6, MIDDLE_RATES = 4, FAST_RATES = 5 };
static const double slow_rates_hz[SLOW_RATES] = {100, 125, 160, 200, 250, 400},
                    middle_rates_hz[MIDDLE_RATES] = {500, 800, 2000, 2500},
                    fast_rates_hz[FAST_RATES] = {5000, 8000, 10000, 16000, 20000};

static void draw_length(Setting* s, Random* random) {
  const bool brief = random_below(random, 2) == 0;
  name_variant(s, brief ? "1.5 to 4 s" : "200,000 to 2 million rows");
  if (brief) {
    s->trajectory = PAPER;
    set_time_unit(s, random_log_uniform(random, 1.5, 4) / 12.5);
    s->sample_time_s = 1 / (1000 * s->units.time_s);
    return;
  }
  const double rate_hz = fast_rates_hz[random_below(random, FAST_RATES)],
               rows = random_log_uniform(random, 2e5, 2e6);
  s->trajectory = MANY_SPEEDS;
  set_time_unit(s, fmin(fmax(rows / (56 * rate_hz), 0.6), 3));
  s->sample_time_s = 1 / (rate_hz * s->units.time_s);
}

/// A part of the mass on a spring, as the diagram knows it too.
static void draw_coupling(Setting* s, double low_hz, double high_hz, Random* random) {
  Physics* p = &s->nominal;
  const double frequency = two_pi * random_log_uniform(random, low_hz, high_hz);
  p->load_kg = p->mass_kg * random_uniform(random, 0.2, 0.5);
  p->gap_m = -1;
  p->coupling_n_per_m = p->load_kg * frequency * frequency;
  p->coupling_n_s_per_m = 2 * random_log_uniform(random, 0.02, 0.1) * frequency * p->load_kg;
}

static void draw_nominal(Setting* s, Random* random) {
  static const char* const names[] = {"gravity", "Stribeck friction", "two masses"};
  const int which = random_below(random, 3);
  name_variant(s, names[which]);
  Physics* p = &s->nominal;
  if (which == 0) p->offset_n = 0.6 * random_log_uniform(random, 0.5, 5);
  if (which == 1) {
    const double level = 0.6 * random_uniform(random, 0.15, 0.5);
    const double static_level = level * random_uniform(random, 1.3, 2.2);
    p->stribeck = (Stribeck){level, static_level, random_log_uniform(random, 0.01, 0.08), 2};
  }
  if (which == 2) draw_coupling(s, 15, 50, random);
}

static void draw_between(Setting* s, Random* random) {
  s->between = (Between)random_below(random, BETWEEN);
  if (random_below(random, 2)) s->late_s = s->sample_time_s * random_uniform(random, 0.1, 0.9);
  name_variant(s, between_names[s->between]);
}

static void draw_few_rows(Setting* s, Random* random) {
  s->trajectory = OSCILLATION;
  const double rows_between_turns = random_log_uniform(random, 6, 45),
               rate_hz = random_below(random, 2) ? slow_rates_hz[random_below(random, SLOW_RATES)]
                                                 : middle_rates_hz[random_below(random, MIDDLE_RATES)];
  s->sample_time_s = 1 / (2 * 0.8 * rows_between_turns);
  set_time_unit(s, 1 / (rate_hz * s->sample_time_s));
  name_variant(s, rows_between_turns < 16 ? "6 to 16 rows between turns" : "16 to 45 rows between turns");
}

static void draw_jitter(Setting* s, Random* random) {
  s->jitter = random_log_uniform(random, 0.02, 0.3);
  s->only_stamps = random_below(random, 4) == 0;
  snprintf(s->variant, sizeof s->variant, "%s",
           s->only_stamps     ? "of the stamps alone"
           : s->jitter < 0.08 ? "2 to 8 %"
                              : "8 to 30 %");
}

static void draw_velocity(Setting* s, Random* random) {
  s->measures_velocity = true;
  s->velocity_noise = top_speed_m_per_s * random_log_uniform(random, 2e-4, 2e-3);
  s->velocity_resolution = random_below(random, 2) ? top_speed_m_per_s / 4096 : 0;
  name_variant(s, s->velocity_resolution > 0 ? "counted" : "analogue");
}

static void draw_condition(Setting* s, Random* random) {
  switch (s->condition) {
    case ROTARY:
      make_rotary(s, 2e-5, 1, 8, random);
      break;
    case JITTER:
      draw_jitter(s, random);
      break;
    case ROUNDED_STAMPS:
      draw_stamps(s, random);
      break;
    case GAPS:
      draw_gaps(s, random);
      break;
    case ORIGIN:
      s->origin_m = random_sign(random) * stroke_m;
      s->origin_m *= random_log_uniform(random, 1, 100);
      name_variant(s, fabs(s->origin_m) < 10 * stroke_m ? "1 to 10 strokes" : "10 to 100 strokes");
      break;
    case COLUMN_UNITS:
      draw_units(s, random);
      break;
    case VOLTAGE:
      draw_voltage(s);
      break;
    case VELOCITY_ONLY:
      draw_velocity(s, random);
      break;
    case COUNTS:
      draw_counts(s, random);
      break;
    case NO_NOISE:
      draw_no_noise(s, random);
      break;
    case LOUD:
      s->noise.white_n *= 10, s->noise.coloured_n *= 10, s->noise.encoder_m *= 10;
      break;
    case LENGTH:
      draw_length(s, random);
      break;
    case KNOWN_NOMINAL:
      draw_nominal(s, random);
      break;
    case LOAD_SIDE:
      draw_coupling(s, 25, 60, random);
      s->nominal.motor_at_load = true;
      break;
    case BETWEEN_SAMPLES:
      draw_between(s, random);
      break;
    case FEW_ROWS:
      draw_few_rows(s, random);
      break;
    default:
      break;
  }
}

static void draw_rate(Setting* s, Random* random) {
  static const char* const names[] = {"100 to 400 Hz", "500 to 2500 Hz", "5 to 20 kHz"};
  const int which = random_below(random, 3);
  name_variant(s, names[which]);
  const double rate_hz = which == 0   ? slow_rates_hz[random_below(random, SLOW_RATES)]
                         : which == 1 ? middle_rates_hz[random_below(random, MIDDLE_RATES)]
                                      : fast_rates_hz[random_below(random, FAST_RATES)];
  s->sample_time_s = 1 / (rate_hz * s->units.time_s);
  if (which == 2) s->trajectory = PAPER;
}

/// As fast as noise, counts, rate and a coupling outside the loop allow: no reading moves the motor by more
/// than a tenth of the force.
static double bandwidth_for(const Setting* s) {
  const double reading_m = fmax(s->noise.resolution_m, 3 * s->noise.encoder_m);
  const double quiet = sqrt(0.06 / (12.8 * s->nominal.mass_kg * reading_m + 1e-12)) / two_pi;
  double bandwidth = fmin(fmin(18, quiet), 1 / (40 * s->sample_time_s));
  if (s->nominal.motor_at_load) {
    const double coupling_hz = sqrt(s->nominal.coupling_n_per_m / s->nominal.load_kg) / two_pi;
    bandwidth = fmin(bandwidth, coupling_hz / 12);
  }
  return bandwidth;
}

Setting setting_draw(Condition condition, Random* random) {
  Setting s = {.condition = condition, .stamp_decimals = 9, .column = "m"};
  const double mass_kg =
      condition == MASS ? random_log_uniform(random, 0.02, 200) : random_log_uniform(random, 0.2, 5);
  draw_base(&s, mass_kg, random_log_uniform(random, 0.2, 1.2), random);
  if (condition == MASS)
    name_variant(&s, mass_kg < 0.2 ? "0.02 to 0.2 kg" : mass_kg < 5 ? "0.2 to 5 kg" : "5 to 200 kg");
  if (condition == RATE) draw_rate(&s, random);
  draw_condition(&s, random);
  // The density of the force noise belongs to the machine: held over longer samples it is smaller.
  s.noise.white_n *= sqrt(0.001 / s.sample_time_s);
  s.motion = motion_make(s.trajectory, random);
  s.bandwidth_hz = bandwidth_for(&s);
  return s;
}

bool setting_allows(const Setting* s, Effect effect) {
  const Physics* p = &s->nominal;
  if (p->load_kg > 0 && (effect == BACKLASH || effect == FLEXIBLE_MODE)) return false;
  if (p->motor_at_load && effect == FORCE_RIPPLE)
    return false;  // along the motor, which the record does not show
  if (p->stribeck.level_n != 0 &&
      (effect == COULOMB_FRICTION || effect == STRIBECK_FRICTION || effect == PRESLIDING_HYSTERESIS))
    return false;
  if (p->offset_n != 0 && effect == CONSTANT_FORCE) return false;
  return !(s->measures_velocity && effect == ENCODER_PERIODIC_ERROR);
}

static void lengthen(Periodic* term, const Setting* s) {
  if (term->amplitude == 0) return;
  const double speed = s->trajectory == OSCILLATION ? 1.0 : 0.4;
  term->pitch_m = fmax(term->pitch_m, 6 * speed * s->sample_time_s);
  const double turn = two_pi / s->units.length;  // whole periods a turn
  if (s->units.is_rotary && term->pitch_m < turn) term->pitch_m = turn / round(turn / term->pitch_m);
}

void setting_adapt(const Setting* s, Effect effect, Physics* p) {
  const double slow = fmax(1, s->sample_time_s / 0.003);
  switch (effect) {
    case INPUT_DELAY:
      p->delay_s *= slow;
      break;
    case ACTUATOR_LAG:
      p->lag_s *= slow;
      break;
    case COGGING:
      lengthen(&p->cogging, s);
      break;
    case VELOCITY_DEPENDENT_COGGING:
      lengthen(&p->moving_cogging, s);
      break;
    case FORCE_RIPPLE:
      lengthen(&p->ripple, s);
      break;
    case ENCODER_PERIODIC_ERROR:
      lengthen(&p->encoder, s);
      p->encoder.amplitude *= fmax(1, s->noise.resolution_m / 5e-7);
      break;
    case FLEXIBLE_MODE:
    case BACKLASH: {
      const double frequency = sqrt(p->coupling_n_per_m / p->load_kg) / two_pi;
      const double share = fmin(1, 1 / (12 * s->sample_time_s * frequency));
      p->coupling_n_per_m *= share * share;
      p->coupling_n_s_per_m *= share;
      break;
    }
    default:
      break;
  }
}
