#include "effects.h"

#include <math.h>
#include <stdlib.h>

#include "hw/emulator/elementary.h"

const char* const effect_names[EFFECTS] = {"inertia",
                                           "viscous_friction",
                                           "coulomb_friction",
                                           "stribeck_friction",
                                           "direction_dependent_friction",
                                           "quadratic_drag",
                                           "eddy_current_drag",
                                           "presliding_hysteresis",
                                           "cogging",
                                           "velocity_dependent_cogging",
                                           "force_ripple",
                                           "force_gain",
                                           "force_saturation",
                                           "constant_force",
                                           "spring",
                                           "hardening_spring",
                                           "end_stop",
                                           "backlash",
                                           "flexible_mode",
                                           "input_delay",
                                           "actuator_lag",
                                           "thermal_drift",
                                           "encoder_periodic_error",
                                           "position_bump",
                                           "uneven_friction",
                                           "sine_in_time",
                                           "uneven_mass",
                                           "step_in_time",
                                           "uneven_damping"};

static const double two_pi = 6.283185307179586;

const char* effect_variables(Effect effect) {
  switch (effect) {
    case POSITION_BUMP:
      return "[\"position\"]";
    case UNEVEN_FRICTION:
      return "[\"position\", \"direction\"]";
    case UNEVEN_MASS:
      return "[\"position\", \"acceleration\"]";
    case UNEVEN_DAMPING:
      return "[\"position\", \"velocity\"]";
    default:
      return "[\"time\"]";
  }
}

double consumed_force(const Physics* physics, double x, double v, double t, double u) {
  const double direction = v > 0 ? 1 : v < 0 ? -1 : 0;
  return plant_resisting_force(physics, x, v, t) + direction * plant_dry_friction(physics, fabs(v), x) + u -
         plant_motor_force(physics, u, x, t);
}

bool effects_clash(Effect one, Effect other) {
  static const Effect pairs[][2] = {{INPUT_DELAY, ACTUATOR_LAG},
                                    {FLEXIBLE_MODE, BACKLASH},
                                    {COULOMB_FRICTION, STRIBECK_FRICTION},
                                    {COULOMB_FRICTION, PRESLIDING_HYSTERESIS},
                                    {STRIBECK_FRICTION, PRESLIDING_HYSTERESIS},
                                    {FORCE_GAIN, INERTIA}};
  for (unsigned i = 0; i < sizeof pairs / sizeof *pairs; ++i)
    if ((one == pairs[i][0] && other == pairs[i][1]) || (one == pairs[i][1] && other == pairs[i][0]))
      return true;
  return one == other;
}

static void write_periodic(FILE* file, const char* amplitude, Periodic term) {
  fprintf(file, "{\"%s\": %.9g, \"pitch\": %.9g, \"sine\": %.9g, \"cosine\": %.9g}", amplitude,
          term.amplitude, term.pitch_m, term.amplitude * cosine_of(term.phase_rad),
          term.amplitude * sine_of(term.phase_rad));
}

void effect_write(FILE* file, Effect effect, const Physics* p) {
  static const char* const drift_names[DRIFTS] = {"force constant", "viscous friction", "constant force"};
  const Stribeck* s = &p->stribeck;
  switch (effect) {
    case INERTIA:
      fprintf(file, "{\"mass\": %.9g}", p->added_mass_kg);
      break;
    case VISCOUS_FRICTION:
      fprintf(file, "{\"damping\": %.9g}", p->added_damping_n_s_per_m);
      break;
    case COULOMB_FRICTION:
      fprintf(file, "{\"level\": %.9g}", p->coulomb_n);
      break;
    case STRIBECK_FRICTION:
      fprintf(file, "{\"level\": %.9g, \"rise\": %.9g, \"speed\": %.9g, \"exponent\": %g}", s->level_n,
              s->static_level_n - s->level_n, s->speed_m_per_s, s->exponent);
      break;
    case DIRECTION_DEPENDENT_FRICTION:
      fprintf(file, "{\"asymmetry\": %.9g}", p->direction_damping_n_s_per_m);
      break;
    case QUADRATIC_DRAG:
      fprintf(file, "{\"drag\": %.9g}", p->quadratic_n_s2_per_m2);
      break;
    case EDDY_CURRENT_DRAG:
      fprintf(file, "{\"damping\": %.9g, \"critical_speed\": %.9g}", p->eddy_n_s_per_m,
              p->eddy_speed_m_per_s);
      break;
    case PRESLIDING_HYSTERESIS:
      fprintf(file, "{\"level\": %.9g, \"distance\": %.9g}", p->dahl_n, p->dahl_distance_m);
      break;
    case COGGING:
      write_periodic(file, "amplitude", p->cogging);
      break;
    case VELOCITY_DEPENDENT_COGGING:
      write_periodic(file, "slope", p->moving_cogging);
      break;
    case FORCE_RIPPLE:
      write_periodic(file, "depth", p->ripple);
      break;
    case FORCE_GAIN:
      fprintf(file, "{\"gain_error\": %.9g}", p->gain);
      break;
    case FORCE_SATURATION:
      fprintf(file, "{\"droop\": %.9g}", p->saturation_per_n);
      break;
    case CONSTANT_FORCE:
      fprintf(file, "{\"level\": %.9g}", p->offset_n);
      break;
    case SPRING:
      fprintf(file, "{\"stiffness\": %.9g, \"rest_position\": %.9g}", p->spring_n_per_m, p->spring_rest_m);
      break;
    case HARDENING_SPRING:
      fprintf(file, "{\"cubic_stiffness\": %.9g, \"rest_position\": %.9g}", p->cubic_n_per_m3,
              p->cubic_rest_m);
      break;
    case END_STOP:
      fprintf(file, "{\"stiffness\": %.9g, \"place\": %.9g}", p->stop_n_per_m, p->stop_m);
      break;
    case BACKLASH: {
      const double frequency = sqrt(p->coupling_n_per_m / p->load_kg);
      fprintf(file,
              "{\"load_mass\": %.9g, \"gap\": %.9g, \"contact_frequency\": %.9g, \"contact_damping\": %.9g}",
              p->load_kg, p->gap_m, frequency / two_pi, p->coupling_n_s_per_m / (2 * frequency * p->load_kg));
      break;
    }
    case FLEXIBLE_MODE: {
      const double frequency = sqrt(p->coupling_n_per_m / p->load_kg);
      fprintf(file, "{\"load_mass\": %.9g, \"frequency\": %.9g, \"damping_ratio\": %.9g}", p->load_kg,
              frequency / two_pi, p->coupling_n_s_per_m / (2 * frequency * p->load_kg));
      break;
    }
    case INPUT_DELAY:
      fprintf(file, "{\"delay\": %.9g}", p->delay_s);
      break;
    case ACTUATOR_LAG:
      fprintf(file, "{\"time_constant\": %.9g}", p->lag_s);
      break;
    case THERMAL_DRIFT:
      fprintf(file, "{\"of\": \"%s\", \"%s\": %.9g, \"time_constant\": %.9g}", drift_names[p->drift_of],
              p->drift_of == DRIFT_OF_FORCE_CONSTANT ? "drift" : "change", p->drift, p->drift_time_s);
      break;
    case ENCODER_PERIODIC_ERROR:
      write_periodic(file, "amplitude", p->encoder);
      break;
    case POSITION_BUMP:
      fprintf(file, "{\"force\": %.9g, \"position\": %.9g, \"width\": %.9g}", p->bump_n, p->bump_m,
              p->bump_width_m);
      break;
    case UNEVEN_FRICTION:
      fprintf(file, "{\"level\": %.9g, \"at\": %.9g}", p->uneven_n, p->uneven_m);
      break;
    case SINE_IN_TIME:
      fprintf(file, "{\"force\": %.9g, \"frequency\": %.9g}", p->hum_n, p->hum_hz);
      break;
    case UNEVEN_MASS:
      fprintf(file, "{\"mass_per_length\": %.9g}", p->uneven_mass_kg_per_m);
      break;
    case STEP_IN_TIME:
      fprintf(file, "{\"force\": %.9g, \"time\": %.9g}", p->step_n, p->step_s);
      break;
    case UNEVEN_DAMPING:
      fprintf(file, "{\"damping_per_length\": %.9g}", p->coupled_n_s_per_m2);
      break;
    default:
      fputs("{}", file);
  }
}

Path path_of(const Motion* motion, const Physics* nominal, double step_s) {
  const int most = (int)(motion->stop_s / step_s) + 1;
  double* all = calloc(5 * (size_t)most, sizeof *all);
  if (!all) abort();
  Path path = {0, all, all + most, all + 2 * most, all + 3 * most, all + 4 * most};
  for (int k = 0; k < most; ++k) {
    const Wanted wanted = motion_at(motion, k * step_s);
    const double x = wanted.position_m, v = wanted.velocity_m_per_s, a = wanted.acceleration_m_per_s2;
    if (fabs(v) < moving_m_per_s) continue;
    path.time_s[path.count] = k * step_s;
    path.position_m[path.count] = x;
    path.velocity_m_per_s[path.count] = v;
    path.acceleration_m_per_s2[path.count] = a;
    path.force_n[path.count++] = nominal->mass_kg * a + plant_resisting_force(nominal, x, v, 0);
  }
  return path;
}
