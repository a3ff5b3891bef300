#include "setting.h"

double mass_unit(const Units* u) { return u->force * u->time_s * u->time_s / u->length; }

static Periodic periodic_in_si(Periodic term, double amplitude, const Units* u) {
  return (Periodic){term.amplitude * amplitude, term.pitch_m * u->length, term.phase_rad};
}

Physics physics_in_si(const Physics* standard, const Units* u) {
  Physics p = *standard;
  const double mass = mass_unit(u), speed = u->length / u->time_s, damping = u->force / speed,
               stiffness = u->force / u->length;
  p.mass_kg *= mass, p.added_mass_kg *= mass, p.load_kg *= mass;
  p.damping_n_s_per_m *= damping, p.added_damping_n_s_per_m *= damping, p.load_damping_n_s_per_m *= damping;
  p.direction_damping_n_s_per_m *= damping, p.eddy_n_s_per_m *= damping, p.coupling_n_s_per_m *= damping;
  p.coulomb_n *= u->force, p.offset_n *= u->force, p.dahl_n *= u->force;
  p.stribeck.level_n *= u->force, p.stribeck.static_level_n *= u->force, p.stribeck.speed_m_per_s *= speed;
  p.eddy_speed_m_per_s *= speed;
  p.quadratic_n_s2_per_m2 *= damping / speed;
  p.saturation_per_n /= u->force;
  p.spring_n_per_m *= stiffness, p.stop_n_per_m *= stiffness, p.coupling_n_per_m *= stiffness;
  p.cubic_n_per_m3 *= stiffness / (u->length * u->length);
  p.dahl_distance_m *= u->length, p.spring_rest_m *= u->length, p.cubic_rest_m *= u->length,
      p.stop_m *= u->length;
  if (p.gap_m > 0) p.gap_m *= u->length;
  p.delay_s *= u->time_s, p.lag_s *= u->time_s, p.drift_time_s *= u->time_s;
  p.drift *= p.drift_of == DRIFT_OF_DAMPING ? damping : p.drift_of == DRIFT_OF_OFFSET ? u->force : 1;
  p.nominal_cogging = periodic_in_si(p.nominal_cogging, u->force, u);
  p.cogging = periodic_in_si(p.cogging, u->force, u);
  p.moving_cogging = periodic_in_si(p.moving_cogging, damping, u);
  p.ripple = periodic_in_si(p.ripple, 1, u);
  p.encoder = periodic_in_si(p.encoder, u->length, u);
  return p;
}
