#ifndef HIDDEN_EFFECTS_PLANT_H
#define HIDDEN_EFFECTS_PLANT_H

#include <stdbool.h>

#include "random.h"

/// The true axis: a carriage with the drawn effects. Every effect that is zero is absent.
///
///   u → delay → lag → saturation, gain, ripple, drift → force;   m dv/dt = force + noise − resisting forces;
///   encoder: x + A sin(2 π x/L + φ).
typedef struct {
  double level_n, static_level_n, speed_m_per_s, exponent;
} Stribeck;

typedef struct {
  double amplitude, pitch_m, phase_rad;  ///< amplitude in the unit of the periodic quantity
} Periodic;

typedef enum { DRIFT_OF_FORCE_CONSTANT, DRIFT_OF_DAMPING, DRIFT_OF_OFFSET, DRIFTS } DriftOf;

typedef struct {
  double mass_kg, damping_n_s_per_m;  ///< contained in the nominal model
  Periodic nominal_cogging;           ///< N

  // The catalogue.
  double added_mass_kg, added_damping_n_s_per_m;
  double coulomb_n;
  Stribeck stribeck;
  double direction_damping_n_s_per_m;  ///< force β |v|: damping B + β forward, B − β backward
  double quadratic_n_s2_per_m2;
  double eddy_n_s_per_m, eddy_speed_m_per_s;  ///< c v/(1 + (v/v_c)²)
  double dahl_n, dahl_distance_m;             ///< dz/dt = (v − |v| z)/x_c, force = level z
  Periodic cogging;                           ///< N
  Periodic moving_cogging;                    ///< N·s/m, times |v|
  Periodic ripple;                            ///< fraction of the force
  double gain;                                ///< force = (1 + gain) u
  double saturation_per_n;                    ///< force = u (1 − s |u|)
  double offset_n;
  double spring_n_per_m, spring_rest_m;
  double cubic_n_per_m3, cubic_rest_m;
  double stop_n_per_m, stop_m;  ///< elastic, at the high end
  /// A load of this mass, part of the total mass, is driven through a gap or a spring.
  double load_kg, load_damping_n_s_per_m;
  double load_friction_n;  ///< dry friction of the load itself, smooth below half a millimetre per second
  double gap_m;  ///< total free travel; < 0: no gap, a spring joins carriage and load
  double coupling_n_per_m, coupling_n_s_per_m;
  /// The motor and its noise push the load, and the spring the carriage: the encoder is on the driven side.
  bool motor_at_load;
  double delay_s, lag_s;
  DriftOf drift_of;
  double drift, drift_time_s;  ///< drift (1 − exp(−t/τ)): fraction, N·s/m or N
  Periodic encoder;            ///< m

  // Outside the catalogue.
  double bump_n, bump_m, bump_width_m;        ///< F exp(−((x − x_b)/w)²/2)
  double uneven_n, uneven_m;                  ///< dry friction that increases along the track: F x/L sign v
  double hum_n, hum_hz, hum_rad;              ///< sine in time
  double uneven_mass_kg_per_m;                ///< m(x) = m + μ x
  double step_n, step_s;                      ///< a force with an onset
  double coupled_n_s_per_m2, coupled_rest_m;  ///< damping that increases along the track: b (x − x_0) v
} Physics;

enum { POSITION, VELOCITY, LAG, DAHL, LOAD_POSITION, LOAD_VELOCITY, STATES };
enum { DELAY_SAMPLES = 16 };

typedef struct {
  const Physics* physics;
  double state[STATES];
  double time_s, sample_time_s;
  int direction;                ///< of dry friction: −1, 1, or 0 while it holds the carriage
  double input[DELAY_SAMPLES];  ///< u[k], u[k − 1], …
  int substeps;                 ///< RK4 steps a sample
} Plant;

Plant plant_at_rest(const Physics* physics, double sample_time_s, int substeps);

/// Holds the input and the noise force over one sample. Fourth order between events. Reversals, contacts,
/// sticking and the arrival of delayed inputs are located.
void plant_sample(Plant* plant, double input_n, double noise_n);

/// The same over any time, with this command at the motor: the delay is the caller's.
void plant_advance(Plant* plant, double duration_s, double input_n, double noise_n);

/// The encoder reading without resolution and noise.
double plant_encoder(const Plant* plant);

/// u after the delay, at the middle of the present sample.
double plant_delayed_input(const Plant* plant);

/// Laws that the scaling of magnitudes and the energy balance also need.
double plant_motor_force(const Physics* physics, double lagged_n, double position_m, double time_s);
double plant_resisting_force(const Physics* physics, double position_m, double velocity_m_per_s,
                             double time_s);
double plant_dry_friction(const Physics* physics, double speed_m_per_s, double position_m);
double plant_coupling_force(const Physics* physics, const double state[STATES]);
double plant_carriage_mass(const Physics* physics, double position_m);
double periodic(Periodic term, double position_m);

#endif
