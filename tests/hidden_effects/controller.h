#ifndef HIDDEN_EFFECTS_CONTROLLER_H
#define HIDDEN_EFFECTS_CONTROLLER_H

/// A sampled transfer function in 1/z, transposed direct form II.
enum { FILTER_ORDER = 4 };

typedef struct {
  double numerator[FILTER_ORDER + 1], denominator[FILTER_ORDER + 1];  ///< denominator[0] = 1
  double state[FILTER_ORDER];
} Filter;

double filter_step(Filter* filter, double input);

/// Either PD on the position error + feedforward force − disturbance observer, or position P over velocity P.
typedef enum { PD_WITH_OBSERVER, CASCADE, CONTROLLERS } ControllerKind;
extern const char* const controller_names[CONTROLLERS];

typedef struct {
  ControllerKind kind;
  Filter feedback;           ///< PD: position error → N
  Filter observer_position;  ///< Q(z) (M s² + B s) by differences: position → N
  Filter
      observer_command;  ///< Q(z) (1 + 1/z)/2 on the previous command: the mean acts at the second difference
  double previous_command_n;
  double position_gain_per_s, velocity_gain_n_s_per_m;
  Filter velocity;  ///< backward difference
} Controller;

/// Tuned for the nominal mass and damping.
Controller controller_make(ControllerKind kind, double mass_kg, double damping_n_s_per_m,
                           double sample_time_s);

/// PD on the position error alone, of this bandwidth, with the derivative behind a low-pass.
Controller controller_pd(double mass_kg, double damping_n_s_per_m, double sample_time_s, double bandwidth_hz,
                         double low_pass_hz);

double controller_step(Controller* controller, double reference_m, double feedforward_n, double measured_m);

#endif
