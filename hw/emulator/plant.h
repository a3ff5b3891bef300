/* The motor on the bench: a linear motor with its amplifier, integrated every 20 us.
 *
 * Written from the laws of physics alone; nothing here is shared with the simulator, which it serves to
 * verify. */
#ifndef HIL_EMULATOR_PLANT_H
#define HIL_EMULATOR_PLANT_H

enum { PLANT_HARMONICS = 4 };

/* M dv/dt = Kf i - friction - cogging - cable - weight, SI units throughout. */
struct plant {
  /* amplifier and coil */
  double amplifier_gain;  /* A/V */
  double current_limit;   /* A */
  double current_lag;     /* s; 0: none */
  double force_constant;  /* N/A */
  /* mechanics */
  double mass, payload;        /* kg */
  double load_at, load_change; /* s, kg: from then on */
  double damping, drag;        /* N s/m, N s^2/m^2 */
  double coulomb, transition_speed;
  double coulomb_backward;     /* N; added when moving backward */
  double stribeck, stribeck_speed; /* N above coulomb, decaying as exp(-(v/vs)^2) */
  double offset;               /* N, pulls backward */
  double tilt;                 /* rad */
  double cable, cable_center;  /* N/m, m */
  double pole_pitch;           /* m */
  double cogging[PLANT_HARMONICS], cogging_phase[PLANT_HARMONICS]; /* N, rad; harmonic 1, 2, … */
  double cogging_slope;        /* s/m: fraction lost per speed */
  double cogging_modulation, modulation_period;
  double stop_low, stop_high, restitution; /* m, m, 1 */
  /* state */
  double position, velocity, current;
};

void plant_reset(struct plant* p);
/* Advances from `now` (s) by `seconds`, at a constant voltage at the amplifier's input. */
void plant_advance(struct plant* p, double volts, double now, double seconds);

#endif
